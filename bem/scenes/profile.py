"""The tables `[shape.wheel]` and `[shape.rail]`: a profile of the catalogue, or of a file."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, get_args

from pydantic import Field, model_validator

from bem.errors import InputError
from bem.scenes.common import Table, exactly_one, problem
from bem.scenes.keys import key
from bem.scenes.paths import checksum_of, what_is_wrong_with
from bem.scenes.units import Angle, Length

if TYPE_CHECKING:
    from bem.profiles import Profile

ProfileName = Literal["60e1", "s1002", "en15302-rail-a", "en15302-wheel-a"]


class ProfileScene(Table):
    """Profile of a wheel or rail: a name of the catalogue, or a file with columns y (to the right) and z in mm."""

    catalogue: ProfileName | None = key(
        "Name of a profile that comes with the package; or give path.", "basic", default=None, example="60e1"
    )
    path: str | None = key(
        "File with two columns, y to the right and z, in mm, along the curve; relative to the scene file.",
        "basic",
        default=None,
        example="rail.txt",
    )
    vertical: Literal["down", "up"] = key("Direction in which z of the file is counted.", "advanced", default="down")
    smoothing: Annotated[Length, Field(ge=0, le=0.1)] = key(
        "Wavelength of ripples of the file that keep half of their height; waves of twice that length keep 94 %.",
        "advanced",
        default=0.0,
        reason="the spline passes through the points",
        example="3 mm",
    )
    inclination: Annotated[Angle, Field(ge=-0.5, le=0.5)] = key(
        "Rotation of the profile about its origin, right side down.", "advanced", default=0.0, example="-1.432 deg"
    )
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")] | None = key(
        "Checksum of the file, written by a run; a changed file is then refused.", "expert", default=None
    )

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add the name of a profile alone."""
        super().short_forms(table)
        names = {"enum": list(get_args(ProfileName))}
        whole = dict(table)
        table.clear()
        table |= {"anyOf": [names, whole], "description": whole.get("description")}

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, data: Any) -> Any:
        return {"catalogue": data} if isinstance(data, str) else data

    @model_validator(mode="after")
    def _one_profile(self) -> Self:
        exactly_one(self, "catalogue", "path")
        if self.path is None:
            given = [name for name in ("vertical", "smoothing", "sha256") if name in self.model_fields_set]
            if given and getattr(self, given[0]) not in ("down", 0.0, None):
                raise problem(f"{given[0]} of a profile of the catalogue", "it with path")
            return self
        if (wrong := what_is_wrong_with(self.path)) is not None:
            raise problem(*wrong)
        if self.sha256 is not None and self.sha256 != (found := checksum_of(self.path)):
            raise problem(
                f"{Path(self.path).name} has changed since: its SHA-256 is {found[:12]}..., not {self.sha256[:12]}...",
                "the file as it was, or no sha256",
            )
        try:
            self.build()
        except InputError as error:
            raise problem(error.messages[0], "a profile file") from None
        return self

    def build(self) -> Profile:
        """Return the profile; the same object for the same content."""
        content = "" if self.path is None else checksum_of(self.path)
        return _built(self.catalogue, self.path, content, self.vertical, self.smoothing, self.inclination)


@lru_cache(maxsize=32)
def _built(
    catalogue: str | None, path: str | None, content: str, vertical: str, smoothing: float, inclination: float
) -> Profile:
    """Return the profile of a table; `content` is the checksum of the file."""
    from bem.profiles import catalogued_profile, read_profile

    if catalogue is not None:
        profile = catalogued_profile(catalogue)
    else:
        assert path is not None
        profile = read_profile(path, vertical=vertical, smoothing=smoothing)
    return profile.turned(inclination) if inclination else profile
