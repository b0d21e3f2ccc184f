"""Photos of notes, decoded and written again in a confined child process."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4_app.annotations.tuning import ANNOTATIONS

if TYPE_CHECKING:
    from PIL.Image import Image as Photo

FORMATS = ("JPEG", "PNG")


def kept_photo(data: bytes) -> bytes:
    """A photo as it is kept: a JPEG file, upright, small enough, without metadata.

    Nothing of the bytes that were sent is kept: no place, no camera, nothing behind the image.

    Raises:
        ConfigError: If it is no JPEG or PNG file, damaged, or too large.
    """
    from PIL import Image, ImageOps  # the server, which names this function, needs none of it

    try:
        with Image.open(io.BytesIO(data), formats=FORMATS) as image:
            width, height = image.size
            if width * height > ANNOTATIONS.max_pixels:
                raise ConfigError(
                    CodedText(
                        "photo-too-large",
                        width=width,
                        height=height,
                        limit=ANNOTATIONS.max_pixels // 1_000_000,
                    )
                )
            image.draft("RGB", (ANNOTATIONS.photo_px, ANNOTATIONS.photo_px))
            upright = ImageOps.exif_transpose(image)
            plain = _on_white(upright)
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        if isinstance(error, ConfigError):
            raise
        raise ConfigError(CodedText("photo-unreadable", detail=str(error))) from error
    plain.thumbnail((ANNOTATIONS.photo_px, ANNOTATIONS.photo_px))
    out = io.BytesIO()
    plain.save(out, "JPEG", quality=ANNOTATIONS.photo_quality, optimize=True)
    return out.getvalue()


def _on_white(image: Photo) -> Photo:
    """The photo without transparency, and without what belongs to its file."""
    from PIL import Image

    if "A" not in image.getbands() and "transparency" not in image.info:
        plain = image.convert("RGB")
    else:
        whole = image.convert("RGBA")
        plain = Image.new("RGB", whole.size, "white")
        plain.paste(whole, mask=whole.getchannel("A"))
    plain.info = {}
    return plain
