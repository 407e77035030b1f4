"""Pictures of users as a report embeds them: the logo, and photos of pieces."""

import base64
from collections.abc import Iterable

from assess.pictures import PictureError, prepare_picture
from assess.results import ItemResult, Results

MOST_SHOWN = 20_000_000
"""Bytes of all photos that one report embeds: what goes beyond is left out."""


def data_uri(data: bytes, kind: str) -> str:
    """Return bytes as an address that holds them; `kind` is their media type."""
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def embed_logo(results: Results) -> str:
    """Return the address of the logo; "" where there is none."""
    if "logo" not in results.series:
        return ""
    try:
        return data_uri(*prepare_picture(results.series["logo"].tobytes()))
    except PictureError:  # of results whose series were not written by this version, which checks the picture
        return ""


class Photos:
    """The photos of one report."""

    def __init__(self, results: Results) -> None:
        self.series = results.series
        self.of_item = self.series["photo/of_item"].tolist() if "photo/of_item" in self.series else []
        self.left = MOST_SHOWN

    def first_photo(self, results: Iterable[ItemResult]) -> tuple[str, str] | None:
        """Return the name of the first of some pieces that has a photo, and its address; None where none has one."""
        shown = ((one.item.item, self.photo_of(one.item.index)) for one in results)
        return next((pair for pair in shown if pair[1]), None)

    def photo_of(self, item_index: int) -> str:
        """Return the address of the photo of a piece by its `ItemRow.index`; "" without one, or beyond `MOST_SHOWN`."""
        at = self.of_item[item_index] if item_index < len(self.of_item) else -1
        if at < 0 or f"photo/{at}" not in self.series:
            return ""
        data = self.series[f"photo/{at}"].tobytes()
        if len(data) > self.left:
            return ""
        self.left -= len(data)
        return data_uri(data, "image/jpeg")
