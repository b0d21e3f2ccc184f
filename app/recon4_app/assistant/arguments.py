"""Types of the arguments of the tools: what names in an address of the server may be."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

ProjectId = Annotated[
    str,
    Field(
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$",
        description="Id of the project: the name of its folder.",
    ),
]
AnyProject = Annotated[
    str,
    Field(
        pattern=r"^([A-Za-z0-9][A-Za-z0-9._-]{0,63})?$",
        description="Id of a project; empty = any.",
    ),
]
JobId = Annotated[str, Field(pattern=r"^[0-9a-f]{16}$", description="Id of the job.")]
FileName = Annotated[
    str,
    Field(pattern=r"^[a-z0-9_]+(\.[a-z0-9]+){1,2}$", description="A name of `list_exports`."),
]
Crs = Annotated[
    str, Field(description="CRS of a map file, as EPSG:25832; empty = that of the map.")
]
Meters = Annotated[float, Field(ge=-1e8, le=1e8, allow_inf_nan=False)]
Xy = tuple[Meters, Meters]
Color = Literal["height", "intensity", "normalized", "time", "sensor"]
Pair = Annotated[
    tuple[Annotated[int, Field(ge=0)], Annotated[int, Field(ge=0)]],
    Field(description="The two multiframes, as in `list_loops`."),
]
Why = Annotated[str, Field(min_length=1, max_length=500, description="The evidence.")]


class JobRequest(BaseModel):
    """What a job is started with; `inspect_recording` proposes most of it."""

    model_config = ConfigDict(extra="forbid", use_attribute_docstrings=True)

    recordings: list[str] = Field(min_length=1, max_length=16)
    """Paths of `browse_recordings`."""
    project: str = ""
    """Id; an existing project is run again. Empty = a new one, named after its title."""
    title: str = Field(default="", max_length=100)
    """Display name of a new project."""
    only_new: bool = True
    """Refuse the name of an existing project; false = run it again."""
    preset: str = "indoor"
    rig: str = ""
    """Name of a shipped rig or path of a rig file; empty = detected."""
    imu: str = ""
    """CSV file; empty = what the recording has."""
    gnss: str = ""
    """CSV file; empty = what the recording has."""
    settings: list[str] = Field(default=[], max_length=300)
    """``group.field=value`` over the preset."""
    clone_of: str = ""
    """A project whose finished stages the new one reuses."""
