"""Surface files that are none, or larger than they look: one message at once, and memory in proportion to the file."""

import tracemalloc

import numpy as np
import pytest

from bem.errors import SurfaceFileError
from bem.surfaces import read, read_surface

GIVEN = {"spacing": (1e-6, 1e-6), "height_unit": "um"}


def peak_of(path, **arguments):
    """Peak of the memory [bytes] of a reading that is refused, and its message."""
    tracemalloc.start()
    try:
        with pytest.raises(SurfaceFileError) as refused:
            read_surface(path, **arguments)
        return tracemalloc.get_traced_memory()[1], str(refused.value)
    finally:
        tracemalloc.stop()


@pytest.fixture
def one_line(tmp_path):
    """4 MB of numbers in one line; their objects alone would take 0.2 GB."""
    path = tmp_path / "line.txt"
    path.write_text("1 " * 2_000_000)
    return path


def test_a_text_of_one_line_without_spacing_is_refused_unread(one_line):
    peak, said = peak_of(one_line)
    assert "give spacing" in said
    assert peak < 2e6


@pytest.mark.parametrize("suffix", [".txt", ".csv", ".dat"])
def test_a_text_of_one_line_takes_memory_of_its_numbers(one_line, suffix):
    peak, said = peak_of(one_line.rename(one_line.with_suffix(suffix)), **GIVEN)
    assert "not a height map" in said
    assert peak < 15 * 4e6, "8 bytes a number of 2 characters, the line, and room to grow"


@pytest.mark.internal
@pytest.mark.parametrize("separator", [" ", ";", "\t", ",", "   "])
def test_lines_longer_than_a_block_are_read_right(tmp_path, separator):
    heights = np.random.default_rng(5).normal(size=(3, 12_000))
    path = tmp_path / "wide.txt"
    path.write_text("\n".join(separator.join(map(repr, row.tolist())) for row in heights) + "\n")
    assert len(path.read_text().splitlines()[0]) > 3 * read._HEAD
    got = read_surface(path, detrend="none", **GIVEN)
    np.testing.assert_array_equal(got.heights, 1e-6 * heights)


@pytest.mark.internal
@pytest.mark.parametrize("end", ["", "\n", "\r\n"])
def test_empty_fields_are_missing_points(tmp_path, end):
    path = tmp_path / "holes.csv"
    path.write_text(f"# heights\n1;;3;4{end or chr(10)}5;6;7;{end}")
    table = read._read_table(path)[0]
    np.testing.assert_array_equal(table, [[1, np.nan, 3, 4], [5, 6, 7, np.nan]])


@pytest.mark.internal
@pytest.mark.parametrize("cell", ["1;", ";", "12345;"])
def test_a_block_that_ends_at_a_separator_loses_no_field(tmp_path, cell):
    count = 3 * read._HEAD // len(cell)
    path = tmp_path / "edge.txt"
    path.write_text(f"{cell * count}\n{cell * count}\n")
    assert read._read_table(path)[0].shape == (2, count + 1)


@pytest.mark.parametrize(
    ("name", "content", "word"),
    [
        ("x.asc", b"<html></html>", "HTML"),
        ("x.html", b"\n <!DOCTYPE html>\n<html><body>1 2 3</body></html>", "HTML"),
        ("x.txt", b"<HTML>\n1 2 3\n", "HTML"),
        ("x.asc", b"%PDF-1.4\n%\xe2\xe3\n1 0 obj\n", "PDF"),
        ("x.txt", b"%PDF-1.4\n1 2\n3 4\n", "PDF"),
        ("x.nid", b"[DataSet]\r\nVersion=2\r\nGroupCount=1\r\nGr0-Name=Scan\r\n", "unreadable"),
        ("x.nc", b"CDF\x01" + bytes(60), "unreadable"),
        ("x.nc", b"\x89HDF\r\n\x1a\n" + bytes(60), "unreadable"),
        ("x.dat", bytes(5000), "zero bytes"),
        ("x.bin", bytes(5000), "zero bytes"),
    ],
)
@pytest.mark.parametrize("given", [GIVEN, {}])
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # the netCDF reader's own destructor
def test_what_is_no_surface_does_not_ask_for_what_was_given(tmp_path, name, content, word, given):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(SurfaceFileError) as refused:
        read_surface(path, **given)
    assert word in str(refused.value)
    assert "how far its points are apart" not in str(refused.value)


def test_arrays_and_tables_without_spacing_ask_for_it(tmp_path):
    np.save(tmp_path / "a.npy", np.eye(20))
    np.savetxt(tmp_path / "a.txt", np.eye(20))
    np.savetxt(tmp_path / "a.asc", np.eye(20), delimiter=";")
    for name in ("a.npy", "a.txt", "a.asc"):
        with pytest.raises(SurfaceFileError, match=r"how far its points are apart; give spacing") as refused:
            read_surface(tmp_path / name)
        assert "physical_sizes" not in str(refused.value)


def test_a_sparse_file_is_refused_by_its_beginning(tmp_path):
    path = tmp_path / "sparse.dat"
    with open(path, "wb") as stream:
        stream.truncate(8 << 30)
    for given in ({}, GIVEN):
        peak, _ = peak_of(path, **given)
        assert peak < 2e6


@pytest.mark.internal
@pytest.mark.parametrize("name", ["map.txt", "map.npy", "map.asc"])
def test_a_file_larger_than_the_memory_says_how_much_and_what_to_do(tmp_path, name, monkeypatch):
    heights = np.random.default_rng(0).normal(size=(60, 60))
    path = tmp_path / name
    np.save(path, heights) if name.endswith(".npy") else np.savetxt(path, heights)
    assert read_surface(path, **GIVEN).heights.shape == (60, 60)
    monkeypatch.setattr(read, "available_memory", lambda: 11.0 * path.stat().st_size)
    with pytest.raises(SurfaceFileError, match=r"MB of such a file\); crop or thin"):
        read_surface(path, **GIVEN)


@pytest.mark.internal
def test_an_instruments_text_is_bounded_by_what_its_reader_takes(tmp_path, monkeypatch):
    path = tmp_path / "map.asc"
    np.savetxt(path, np.eye(60))
    monkeypatch.setattr(read, "available_memory", lambda: 100.0 * path.stat().st_size)
    with pytest.raises(SurfaceFileError, match="would need about"):
        read_surface(path, **GIVEN)
