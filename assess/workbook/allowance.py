"""How much the files of one workbook may hold together: limits of single files say nothing of a hundred of them."""

from dataclasses import dataclass

from assess.i18n import Text, fill
from assess.workbook.habits import CellError

MOST_RECORD_BYTES = 256_000_000
"""Bytes of the files of recorded motion that a workbook names; a set of a large building has 30 million."""
MOST_RECORD_SAMPLES = 20_000_000
"""Samples of all their channels."""
MOST_ARCHIVES = 50
"""Zip archives among them."""
MOST_PICTURE_PIXELS = 500_000_000
"""Pixels of all pictures."""


@dataclass(slots=True)
class Allowance:
    """What has been taken of it by the files read so far, each file once."""

    record_bytes: int = 0
    samples: int = 0
    archives: int = 0
    pixels: int = 0

    def take_record(self, size: int, *, is_archive: bool) -> None:
        """Count a file of `size` bytes before it is read; CellError where that is more than a workbook may name."""
        self.record_bytes += size
        self.archives += is_archive
        if self.record_bytes > MOST_RECORD_BYTES:
            raise _fewer_records(
                fill("the record files of this workbook have more than {most:.0f} MB.", most=MOST_RECORD_BYTES / 1e6)
            )
        if self.archives > MOST_ARCHIVES:
            raise _fewer_records(fill("this workbook names more than {most} zip archives.", most=MOST_ARCHIVES))

    def take_samples(self, count: int) -> None:
        """Count the samples of a file; CellError where they are too many."""
        self.samples += count
        if self.samples > MOST_RECORD_SAMPLES:
            raise _fewer_records(
                fill("the record files of this workbook have more than {most:,} samples.", most=MOST_RECORD_SAMPLES)
            )

    def take_pixels(self, count: int) -> None:
        """Count the pixels of a picture before it is decoded; CellError where they are too many."""
        self.pixels += count
        if self.pixels > MOST_PICTURE_PIXELS:
            message = fill(
                "the pictures of this workbook have more than {most:.0f} million pixels.",
                most=MOST_PICTURE_PIXELS / 1e6,
            )
            raise CellError(message, fill("Save them smaller, or name fewer."))


def _fewer_records(message: Text) -> CellError:
    return CellError(message, fill("Name fewer files, with the channels that are needed, cut to the shaking."))
