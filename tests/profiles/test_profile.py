"""Profiles: splines through points of an arc, smoothing of a wave, inversion, files and their refusals."""

import itertools
import math

import numpy as np
import pytest

from bem.errors import InputError
from bem.profiles import Profile, read_profile

RADIUS = 0.3


def arc(count, radius=RADIUS, half_angle=0.1):
    angle = np.linspace(-half_angle, half_angle, count)
    return radius * np.sin(angle), radius * (1 - np.cos(angle))


def test_the_curvature_of_an_arc_is_of_second_order_in_the_distance_of_points():
    errors = []
    for count in (21, 41, 81):
        profile = Profile.through(*arc(count))
        s = np.linspace(0.3, 0.7, 37) * profile.knots[-1]
        errors.append(np.abs(profile.curvature(s) * RADIUS - 1).max())
    assert errors[-1] < 2e-5
    assert all(3.5 < one / two < 4.6 for one, two in itertools.pairwise(errors))


@pytest.mark.parametrize(("over", "kept"), [(0.5, 1 / 17), (1.0, 0.5), (2.0, 16 / 17)])
def test_smoothing_keeps_half_of_a_ripple_of_its_wavelength(over, kept):
    """1/(1 + (L/wave)^4) of a line with a ripple of 0.1 um, in the middle of 40 waves."""
    smoothing, height = 3e-3, 1e-7
    wave = over * smoothing
    y = np.linspace(-20 * wave, 20 * wave, 1601)
    profile = Profile.through(y, height * np.cos(2 * math.pi * y / wave), smoothing=smoothing)
    middle = np.linspace(-wave, wave, 201)
    s = profile.parameter_where((1.0, 0.0), middle)
    cosine = np.cos(2 * math.pi * middle / wave)
    assert 2 * np.mean(profile.at(s)[1][:-1] * cosine[:-1]) / height == pytest.approx(kept, rel=2e-3)


def test_points_from_right_to_left_are_turned_and_turning_is_a_rotation():
    y, z = arc(41)
    profile, mirrored = Profile.through(y, z), Profile.through(y[::-1], z[::-1])
    s = np.linspace(0, profile.knots[-1], 23)
    assert np.allclose(profile.at(s), mirrored.at(s), atol=1e-15)
    turned = profile.turned(0.2, about=(0.01, 0.02))
    across, down = profile.at(s)
    cosine, sine = math.cos(0.2), math.sin(0.2)
    expected = (
        0.01 + cosine * (across - 0.01) - sine * (down - 0.02),
        0.02 + sine * (across - 0.01) + cosine * (down - 0.02),
    )
    assert np.allclose(turned.at(s), expected, atol=1e-15)


def test_parameters_are_found_to_round_off_and_not_beyond_the_ends():
    profile = Profile.through(*arc(41))
    wanted = np.array([-0.02, 0.0, 0.013, 0.2])
    found = profile.parameter_where((1.0, 0.0), wanted)
    assert np.allclose(profile.at(found[:3])[0], wanted[:3], atol=1e-16)
    assert np.isnan(found[3])


@pytest.mark.parametrize(
    ("y", "z", "smoothing", "message"),
    [
        (1.0, 2.0, 0.0, "of one length"),
        (np.arange(9.0), np.zeros(8), 0.0, "of one length"),
        (np.arange(9.0), np.zeros(9), "a", "smoothing 'a'"),
        (np.arange(9.0), np.zeros(9), math.nan, "smoothing nan"),
    ],
)
def test_arrays_and_smoothing_that_are_none_are_refused(y, z, smoothing, message):
    with pytest.raises(InputError, match=message):
        Profile.through(y, z, smoothing=smoothing)


def test_files_have_headers_separators_and_either_direction(tmp_path):
    y, z = arc(12)
    text = "# a rail\nname; test\n" + "".join(f"{1e3 * a:.9f};{1e3 * b:.9f}\n" for a, b in zip(y, z, strict=True))
    (tmp_path / "down.txt").write_text(text)
    (tmp_path / "up.txt").write_text("".join(f"{1e3 * a:.9f}, {-1e3 * b:.9f}\n" for a, b in zip(y, z, strict=True)))
    down, up = read_profile(tmp_path / "down.txt"), read_profile(tmp_path / "up.txt", vertical="up")
    assert np.allclose(down.at(down.knots), (y, z), atol=1e-12)
    assert np.allclose(up.at(up.knots), (y, z), atol=1e-12)


@pytest.mark.parametrize("line", ["{};{}\n", "{} ; {};\n", "{}\t{}\n", "{} {} a word\n"])
def test_decimal_commas_are_read_beside_semicolons_and_blanks(tmp_path, line):
    y, z = arc(12)
    rows = [line.format(f"{1e3 * a:.9f}", f"{1e3 * b:.9f}") for a, b in zip(y, z, strict=True)]
    (tmp_path / "comma.txt").write_text("y (mm);z (mm)\n" + "".join(rows).replace(".", ","))
    found = read_profile(tmp_path / "comma.txt")
    assert np.allclose(found.at(found.knots), (y, z), atol=1e-12)


@pytest.mark.parametrize("line", ["{},{}\n", "{}, {}\n", "{} ,{}\n", "{},{} mm\n"])
def test_commas_separate_columns_otherwise(tmp_path, line):
    y = np.arange(-30, 31, 5)
    (tmp_path / "whole.txt").write_text("".join(line.format(a, a * a // 25) for a in y))
    found = read_profile(tmp_path / "whole.txt")
    assert np.allclose(found.at(found.knots), (1e-3 * y, 1e-3 * (y * y // 25)), atol=1e-12)


def test_a_first_point_beside_the_others_is_no_count(tmp_path):
    (tmp_path / "p.txt").write_text("".join(f"{12 - i} {i * i}\n" for i in range(13)))
    assert len(read_profile(tmp_path / "p.txt").knots) == 13


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 2\n3 4\n", "begin with two numbers"),
        ("1 2\n" * 9, "points"),
        ("x\n" * 20, "begin with two numbers"),
        ("".join(f"{i + 1} {i}.5 {0.1 * i}\n" for i in range(12)), "line 1 has 3 numbers"),
        ("y;z\n" + "".join(f"{i},5;{i},25;0,1\n" for i in range(12)), "line 2 has 3 numbers"),
        ("12 2\n" + "".join(f"{i - 6} {0.1 * i}\n" for i in range(12)), "counts the 12 points"),
        ("".join(f"{1e-3 * i} {1e-4 * i}\n" for i in range(60)), "0.0593 mm long"),
        ("".join(f"{1e3 * i} {i}\n" for i in range(60)), "long; allowed: 5 to 1000 mm"),
    ],
)
def test_files_that_are_none_are_refused(tmp_path, text, message):
    (tmp_path / "p.txt").write_text(text)
    with pytest.raises(InputError, match=message):
        read_profile(tmp_path / "p.txt")
    with pytest.raises(InputError, match="vertical"):
        read_profile(tmp_path / "p.txt", vertical="sideways")
    with pytest.raises(InputError, match="cannot be read"):
        read_profile(tmp_path / "none.txt")
