"""Ranges, lists and seeds as they are typed."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.errors import InputError
from bem.scenes.ranges import parse_axes, parse_axis

pytestmark = pytest.mark.internal


@pytest.mark.parametrize(
    ("text", "key", "values"),
    [
        ("contact.load=1 N:10 N:4", "contact.load", ("1 N", "4 N", "7 N", "10 N")),
        ("contact.load=1:2:3", "contact.load", ("1.0", "1.5", "2.0")),
        ("contact.load=log:1 N:100 N:3", "contact.load", ("1 N", "10 N", "100 N")),
        ("contact.load=500 mN:2 N:4", "contact.load", ("500 mN", "1000 mN", "1500 mN", "2000 mN")),
        ("grid.shape=log:64:512:4", "grid.shape", ("64", "128", "256", "512")),
        ("grid.shape=64:256:4", "grid.shape", ("64", "128", "192", "256")),
        ("seed=1:5", "seed", ("1", "2", "3", "4", "5")),
        ("seed=3:1", "seed", ("3", "2", "1")),
        ("seed=7", "seed", ("7",)),
        ("contact.behaviour=elastic, capped", "contact.behaviour", ("elastic", "capped")),
        ('cylinder.loads=["1 N","2 N"],["3 N"]', "cylinder.loads", ('["1 N","2 N"]', '["3 N"]')),
        ('a.path="x,y.di","z:1.di"', "a.path", ('"x,y.di"', '"z:1.di"')),
        ("x=log:1 GPa:100 MPa:2", "x", ("1.0 GPa", "0.1 GPa")),
        ("variants[0].cells=8,16", "variants[0].cells", ("8", "16")),
        (" variants . 0 .cells = 8,16", "variants[0].cells", ("8", "16")),
        ("a.1.2=1:2", "a[1][2]", ("1", "2")),
    ],
)
def test_values(text, key, values):
    axis = parse_axis(text)
    assert (axis.key, axis.values) == (key, values)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("nothing", "form key=values"),
        ("=1,2", "form key=values"),
        ("a..b=1,2", "form key=values"),
        ("a=", "form key=values"),
        ("a=1,,2", "empty value"),
        ("a=1,1", "same value twice"),
        ("a=1:2:1", "count"),
        ("a=1:2:x", "count"),
        ("a=1:2:3:4", "first:last:count"),
        ("a=x:2:3", "not a number"),
        ("a=log:0:1:3", "not positive"),
        ("a=log:1:2", "first:last:count"),
        ("a=1.5:2", "whole numbers"),
        ("a=1 N:2 m:3", "different dimensions"),
        ("a=1 N:2 furlongs:3", "different dimensions"),
        ("a=1 N:2 xyzzy:3", "unknown unit"),
        ("a=1:99999999999", "more than"),
        ("0=1,2", "form key=values"),
        ("[0]=1,2", "form key=values"),
        ("a[-1]=1,2", "form key=values"),
        ("a[x]=1,2", "form key=values"),
        ("a[0=1,2", "form key=values"),
        ("a[]=1,2", "form key=values"),
    ],
)
def test_mistakes_say_what_is_allowed(text, why):
    with pytest.raises(InputError, match="allowed: ") as caught:
        parse_axis(text)
    assert why in str(caught.value)


def test_values_from_a_file(tmp_path):
    file = tmp_path / "loads.txt"
    file.write_text("# measured\n2.5 N\n\n  5 N\n")
    axis = parse_axis(f"contact.load=@{file}")
    assert (axis.key, axis.values, axis.spacing) == ("contact.load", ("2.5 N", "5 N"), "list")
    for content, why in (("# none\n", "holds no values"), ("1\n1\n", "same value twice"), ("\udcff", "cannot be read")):
        file.write_bytes(content.encode("utf-8", "surrogateescape"))
        with pytest.raises(InputError, match=f"{why}.*allowed: "):
            parse_axis(f"contact.load=@{file}")
    with pytest.raises(InputError, match=r"No such file.*allowed: a text file"):
        parse_axis(f"contact.load=@{tmp_path}/nowhere")


def test_an_index_counts_as_the_same_key_however_it_is_written():
    with pytest.raises(InputError, match=r"a\[0\].*more than once"):
        parse_axes(["a[0]=1,2", "a.0=3,4"])


def test_all_mistakes_at_once():
    with pytest.raises(InputError) as caught:
        parse_axes(["a=1,,2", "b=1:2:1", "c=1", "c=2"])
    assert len(caught.value.messages) == 3
    with pytest.raises(InputError, match="--over: missing"):
        parse_axes([])
    with pytest.raises(InputError, match="more than 100000 points"):
        parse_axes(["a=1:1000", "b=1:1000"])


@given(st.text(max_size=30), st.text(max_size=30))
@settings(deadline=None, max_examples=150)
def test_any_text_is_read_or_refused(key, body):
    try:
        axis = parse_axis(f"{key}={body}")
    except InputError as error:
        assert "allowed" in str(error)  # noqa: PT017
        return
    assert axis.values
    assert len(set(axis.values)) == len(axis.values)


@pytest.mark.parametrize("before", ["5, 20", "0, 20"])
def test_a_list_with_a_unit_at_its_last_value_alone_is_refused(before):
    """ "5, 20, 80 MPa" was read as 5 Pa, 20 Pa and 80 MPa."""
    with pytest.raises(InputError, match="only the last value has a unit") as caught:
        parse_axis(f"contact.mean_pressure={before}, 80 MPa")
    each = ", ".join(f"{value} MPa" for value in before.split(", "))
    assert f'contact.mean_pressure="{each}, 80 MPa"' in str(caught.value)


@pytest.mark.parametrize("text", ["5 MPa, 20 MPa", "0, 20 MPa", "5, 20", "5 MPa, 20", "a, b", "1, 2 parts"])
def test_other_lists_are_read_as_they_are(text):
    assert parse_axis(f"contact.mean_pressure={text}").values == tuple(text.split(", "))
