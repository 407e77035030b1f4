"""Zip archives of records, as data centres deliver them: read without unpacking them to the disk."""

import io
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from assess.errors import RecordError
from assess.i18n import Text, fill, join
from assess.motion.formats._format import MOST_VALUES, too_many_values
from assess.motion.record import Record
from assess.progress import SILENT, Progress

MOST_UNPACKED = 256_000_000
"""Bytes that are unpacked of one file that a user names; a set of a large building has 30 million."""
LARGEST_MEMBER = 64_000_000
"""Bytes of one member."""
MOST_MEMBERS = 5_000
"""Members, those of inner archives counted with them."""
DEEPEST = 3
"""Archives within archives: the CSMIP sets have two levels."""
MOST_RATIO, RATIO_FROM = 200, 1_000_000
"""Unpacked over packed size [-] that is believed, of members with more than so many bytes; text packs to a tenth."""
LONGEST_NAME = 240
"""Characters that are kept of a member's path."""
LISTED = 8
"""Members that an error lists."""

_STARTS = (b"PK\x03\x04", b"PK\x05\x06")
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_OFFICE = ("[Content_Types].xml", "META-INF/manifest.xml")

ReadMember = Callable[[bytes, str], tuple[Record, ...] | None]


def is_archive(head: bytes) -> bool:
    """Return whether a file that starts with `head` is a zip archive (or a workbook, which is one, too)."""
    return head.startswith(_STARTS)


def read_archive(data: bytes, file: str, read: ReadMember, progress: Progress = SILENT) -> tuple[Record, ...]:
    """Read every channel of every member that `read` can read from its bytes and name, inner archives included.

    `read` returns None for a file of no known format. The name of a member's record is
    ``file/inner.zip/folder/member``. Raises RecordError if nothing in it can be read, it is locked, or it unpacks to
    more than a set of records can have.
    """
    found = _Walk(read, progress)
    found.enter(data, file, depth=1)
    listed, more = join("; ", found.reasons[:LISTED]), len(found.reasons) - LISTED
    if found.records and not found.reasons:
        return tuple(found.records)
    if found.records:
        note = fill("left out of the archive: {members}", members=listed)
        # Once in a set, or each of its channels would repeat it in a report.
        first, *others = found.records
        return (replace(first, notes=(*first.notes, note)), *others)
    if not found.reasons:
        raise RecordError.about("the zip archive is empty. Get it again")
    listed = fill("{members}; and {more} more", members=listed, more=more) if more > 0 else listed
    raise RecordError.about("nothing in the zip archive can be read as a record: {members}", members=listed)


class _BombError(RecordError):
    """About an archive of which nothing further is read."""


def clean_name(member: zipfile.ZipInfo) -> str:
    """Return how a member is called: its path with signs that cannot be printed exchanged; never empty."""
    name = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in member.filename)
    return name.replace("\\", "/")[:LONGEST_NAME] or fill("member without a name")


@dataclass(slots=True)
class _Walk:
    """Goes through an archive; what it has found so far, and how much was unpacked for that [bytes]."""

    read: ReadMember
    progress: Progress
    records: list[Record] = field(default_factory=list)
    reasons: list[Text] = field(default_factory=list)
    unpacked: int = 0
    members: int = 0
    values: int = 0

    def enter(self, data: bytes, file: str, depth: int) -> None:
        if depth > DEEPEST:
            raise RecordError.about("the zip archives are nested more than {most} deep: unpack them", most=DEEPEST)
        # Its entries, before the directory is read: an entry takes a hundred times its bytes then.
        self._count(data.count(b"PK\x01\x02"))
        try:
            archive = zipfile.ZipFile(io.BytesIO(data))
        except Exception as error:  # what zipfile raises of damaged archives is any of ten kinds
            raise RecordError.about("the zip archive is damaged: its directory cannot be read. Get it again") from error
        with archive:
            # Python 3.11's is_dir() fails where the name is empty.
            members = [member for member in archive.infolist() if not member.filename.endswith("/")]
            self.members += len(members)
            self._count(self.members)
            if any(member.filename in _OFFICE for member in members):
                raise RecordError.about(
                    "the file is a workbook or another office file, not a record: save the sheet as CSV"
                )
            if locked := next((member for member in members if member.flag_bits & 0x1), None):
                raise _BombError.about(
                    "{member} is locked with a password: unpack the archive, and name the file of the channel",
                    member=clean_name(locked),
                )
            for member in members:
                self.progress.check()
                name = clean_name(member)
                try:
                    content, place = self._unpack(archive, member), f"{file}/{name}"
                    if is_archive(content):
                        self.enter(content, place, depth + 1)
                        continue
                    found = self.read(content, name)
                    if found is None:
                        raise RecordError.about("unsupported file format")
                    self.records += [replace(record, file=place) for record in found]
                    self.values += sum(record.acceleration.size for record in found)
                    if self.values > MOST_VALUES:
                        raise _BombError(too_many_values().message)
                except _BombError:
                    raise
                except RecordError as error:
                    self.reasons.append(fill("{member}: {why:.160}", member=name, why=error.message))

    def _count(self, members: int) -> None:
        if members > MOST_MEMBERS:
            raise _BombError.about("the zip archive has more than {most:,} members: unpack it", most=MOST_MEMBERS)

    def _unpack(self, archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> bytes:
        """Unpack one member, whatever size the archive gives it, no further than the limits."""
        if member.compress_type not in _METHODS:
            raise RecordError.about(
                "the file is compressed by a method that is not supported ({method}): unpack the archive",
                method=member.compress_type,
            )
        if member.file_size > max(RATIO_FROM, MOST_RATIO * member.compress_size):
            raise _BombError.about(
                "{member} unpacks to more than {most} times its size, which no record does. Get the archive again",
                member=clean_name(member),
                most=MOST_RATIO,
            )
        room = min(LARGEST_MEMBER, MOST_UNPACKED - self.unpacked)
        why = fill("the file is damaged: its header and the directory of the zip archive differ. Get it again")
        try:
            with archive.open(member) as file:
                why = fill("the file is damaged: its data cannot be unpacked. Get it again")
                # Of a member that is larger than its directory entry, no more than that is unpacked.
                content = file.read(min(room, member.file_size) + 1)
        except Exception as error:  # see above
            raise RecordError(why) from error
        self.unpacked += len(content)
        if len(content) > room:
            raise _BombError.about(
                "the zip archive holds more than {most:.0f} MB, or {largest:.0f} MB in one member: unpack it, and name "
                "the file of the channel",
                most=MOST_UNPACKED / 1e6,
                largest=LARGEST_MEMBER / 1e6,
            )
        return content
