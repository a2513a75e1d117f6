# SPDX-License-Identifier: GPL-3.0-or-later
"""Open leapmap's files as h5py does, and refuse anything that no such file holds before reading it.

A file from another person may refer to other files of the machine, or demand more memory than it has bytes
for. An interrupted sweep may leave a journal at the end of its .part: writes that HDF5 itself cannot see."""
import contextlib
import fcntl
import io
import os
import stat
import struct
import zlib

# no file makes HDF5 run other code; read as the library is loaded
os.environ.setdefault("HDF5_PLUGIN_PRELOAD", "::")
import h5py  # noqa: E402

FILTERS = [h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_FLETCHER32]
MOST_ATTRIBUTES = 256
MOST_OBJECTS = 4096
MOST_CHUNK = 2**28
MOST_WRITES = 1_000_000
DEFLATION = 1032  # the most that zlib's format packs into a byte
HOLES = 2**30  # bytes that an unfinished map may have to be filled up with
FOOTER = struct.Struct("<16sQQII")  # magic, where the journal begins, the file's size after it, 0, CRC-32
HEAD = struct.Struct("<QQ")  # offset, length


class Refused(Exception):
    """The file is not what leapmap writes, or somebody is writing it."""


def _bytes_at(file, begin, count):
    file.seek(begin)
    content = file.read(count)
    if len(content) != count:
        raise OSError("it ends too early")
    return content


class Watched(io.RawIOBase):
    """A file for HDF5, which must not be thrown at: where reading fails zeros stand, and the reason is
    kept."""

    def __init__(self, file):
        super().__init__()
        self.file, self.errno, self.damage = file, 0, ""

    def readable(self):
        return True

    def seekable(self):
        return True

    def _note(self, error):
        if error.errno:
            self.errno = self.errno or error.errno
        else:
            self.damage = self.damage or str(error)

    def seek(self, offset, whence=io.SEEK_SET):
        try:
            return self.file.seek(offset, whence)
        except OSError as error:
            self._note(error)
            return offset

    def tell(self):
        return self.file.tell()

    def readinto(self, buffer):
        view = memoryview(buffer).cast("B")
        count = 0
        try:
            count = self.file.readinto(view) or 0
        except OSError as error:
            self._note(error)
        view[count:] = bytes(len(view) - count)  # as HDF5's own driver does beyond a file's end
        return len(view)

    def rethrow(self):
        if self.errno:
            raise OSError(self.errno, os.strerror(self.errno))
        if self.damage:
            raise Refused(f"is damaged: {self.damage}")


class WithJournal(io.RawIOBase):
    """A file as it will be once its journal is made: HDF5 reads it through this."""

    def __init__(self, file, begin, size):
        super().__init__()
        self.file, self.size, self.place, self.writes = file, size, 0, []
        journal = _bytes_at(file, begin, os.fstat(file.fileno()).st_size - FOOTER.size - begin)
        at = 0
        while at < len(journal):
            if at + HEAD.size > len(journal):
                raise Refused("is damaged: its journal makes no sense")
            offset, length = HEAD.unpack_from(journal, at)
            at += HEAD.size
            if not 0 < length <= len(journal) - at or len(
                    self.writes) >= MOST_WRITES or offset + length > begin:
                raise Refused("is damaged: its journal makes no sense")
            self.writes.append((offset, journal[at:at + length]))
            at += length

    def readable(self):
        return True

    def seekable(self):
        return True

    def seek(self, offset, whence=io.SEEK_SET):
        self.place = {io.SEEK_SET: 0, io.SEEK_CUR: self.place, io.SEEK_END: self.size}[whence] + offset
        return self.place

    def tell(self):
        return self.place

    def readinto(self, buffer):
        view = memoryview(buffer).cast("B")
        count = max(0, min(len(view), self.size - self.place))
        view[:count] = _bytes_at(self.file, self.place, count)
        for offset, data in self.writes:
            first, last = max(self.place, offset), min(self.place + count, offset + len(data))
            if first < last:
                view[first - self.place:last - self.place] = data[first - offset:last - offset]
        self.place += count
        return count


def _with_journal(file):
    """The file, or, if it ends with a journal, the file as that leaves it."""
    size = os.fstat(file.fileno()).st_size
    if size < FOOTER.size:
        return file
    magic, begin, whole, _, checksum = FOOTER.unpack(_bytes_at(file, size - FOOTER.size, FOOTER.size))
    if magic != b"leapmap journal\n" or begin > size - FOOTER.size:
        return file
    found, left = 0, size - 4 - begin
    while left > 0:
        block = _bytes_at(file, size - 4 - left, min(left, 2**20))
        found, left = zlib.crc32(block, found), left - len(block)
    if found != checksum:
        return file  # a commit that never came to its end
    if whole > begin or size - begin > 2**30:
        raise Refused("is damaged: its journal makes no sense")
    return WithJournal(file, begin, whole)


def _refusal(dataset, file_size, texts):
    """What is wrong with a dataset, before any of its values is read; empty: nothing."""
    creation = dataset.id.get_create_plist()
    if creation.get_layout() == h5py.h5d.VIRTUAL:
        return ("is a virtual dataset, made of other files, which charts do not follow; leapmap join "
                "without --virtual copies them")
    if creation.get_external_count():
        return "has its values in another file"
    if dataset.id.get_type().detect_class(h5py.h5t.REFERENCE):
        return "holds references"
    if not texts and h5py.check_vlen_dtype(dataset.dtype) or h5py.check_string_dtype(
            dataset.dtype) and not texts:
        return "holds texts, or rows of any length"
    filters = [creation.get_filter(i)[0] for i in range(creation.get_nfilters())]
    # each once, in our order: deflated twice, a few bytes would take any memory
    if filters != [f for f in FILTERS if f in filters]:
        return "is packed by a filter that leapmap does not use"
    if dataset.id.get_storage_size() > file_size:
        return "says that it is larger than the file"
    if len(dataset.attrs) > MOST_ATTRIBUTES:
        return "has more attributes than any dataset of leapmap's"
    size = dataset.id.get_type().get_size()
    if creation.get_layout() == h5py.h5d.CHUNKED:
        chunk = size
        for extent in creation.get_chunk():
            chunk *= extent
        if chunk > MOST_CHUNK:
            return "has chunks larger than leapmap writes"
    return ""


def _claimed(dataset):
    """Bytes that a dataset's values take in memory beyond what its stored bytes could hold."""
    size = dataset.id.get_type().get_size()
    for extent in dataset.shape or ():
        size *= extent
    return max(0, size - DEFLATION * dataset.id.get_storage_size())


def names_in(group):
    """The names of a group's links. Not by h5py's own loop: HDF5 would gather a sorted table first, and free
    what it never set where the disk fails meanwhile."""
    names = []
    group.id.links.iterate(lambda name: names.append(name.decode(errors="replace")),
                           order=h5py.h5.ITER_NATIVE)
    return sorted(names)


def _refuse_foreign_parts(file, file_size, texts):
    """Looks at every link and dataset of the file, and reads none."""
    seen, claimed = 0, 0
    groups, visited = [("", file)], set()
    if len(file.attrs) > MOST_ATTRIBUTES:
        raise Refused("is refused: it has more attributes than any file of leapmap's")
    holes = HOLES if "tiles_done" in file.attrs else 0
    while groups:
        path, group = groups.pop()
        for name in names_in(group):
            seen += 1
            if seen > MOST_OBJECTS:
                raise Refused("is refused: holds more objects than any file of leapmap's")
            link = group.get(name, getlink=True)
            if isinstance(link, h5py.SoftLink):
                continue  # leads nowhere but into the same file
            place = repr(f"{path}{name}")[1:-1]
            if not isinstance(link, h5py.HardLink):
                raise Refused(f"is refused: {place} is a link into another file")
            thing = group[name]
            if isinstance(thing, h5py.Group):
                address = h5py.h5o.get_info(thing.id).addr
                if address not in visited:
                    visited.add(address)
                    groups.append((f"{path}{name}/", thing))
            elif not isinstance(thing, h5py.Dataset):
                raise Refused(f"is refused: {place} is neither a dataset nor a group")
            elif refusal := _refusal(thing, file_size, texts is True or place in texts):
                raise Refused(f"is refused: {place} {refusal}")
            else:
                claimed += _claimed(thing)
                if claimed > holes:
                    raise Refused(
                        f"is refused: {place} says that it holds more values than the file has bytes for")


@contextlib.contextmanager
def opened(path, filetype, texts=()):
    """A file of that type as h5py has it, for reading; texts: names of the datasets that may hold texts, or
    True for all. Raises Refused or OSError."""
    with contextlib.ExitStack() as stack:
        # Not blocking: to open a pipe would wait for whoever writes to it.
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        raw = stack.enter_context(os.fdopen(descriptor, "rb"))
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise Refused("is a device, a pipe or a folder")
        try:
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Refused("a sweep is writing it; wait until that has ended") from None
        except OSError:
            # a file system without locks: nothing is written here, and HDF5 itself refuses what it cannot
            # lock
            pass
        content = Watched(_with_journal(raw))
        try:
            h5 = stack.enter_context(h5py.File(content, "r"))
            told = h5.attrs.get("filetype")
            if not isinstance(told, str) or told != filetype:
                raise Refused(
                    f"is not a {filetype} (its attribute filetype is {' '.join(repr(told).split())[:80]})")
            _refuse_foreign_parts(h5, os.fstat(descriptor).st_size, texts)
            yield h5
        finally:
            content.rethrow()  # the system failed, whatever that was taken for
