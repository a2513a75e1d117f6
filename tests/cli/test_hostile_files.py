# SPDX-License-Identifier: GPL-3.0-or-later
"""Files from others are data: whatever they refer to or claim, nothing else is read, written or believed."""
import os
import random
import resource
import shutil
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, SMALL, TOP, leapmap, scripted, sweep

sys.path.insert(0, str(TOP / "analysis"))
from read_map import NotAMap, read_map  # noqa: E402


def limited(megabytes, *words):
    """A run that may not take more memory."""
    cap = megabytes * 10**6
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=60, env=dict(
        os.environ, OMP_NUM_THREADS="2"),
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (cap, cap)))


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    return sweep(tmp_path_factory.mktemp("hostile"))


@pytest.fixture
def victim(tmp_path):
    (tmp_path / "victim").write_bytes(b"\x06" * 4096)
    return tmp_path / "victim"


def replaced(path, name, create):
    """The map with a dataset in place of its own."""
    with h5py.File(path, "r+") as m:
        shape, about = m[name].shape, dict(m[name].attrs)
        del m[name]
        create(m, name, shape)
        if name in m and isinstance(m.get(name, getlink=True), h5py.HardLink) and isinstance(
                m[name], h5py.Dataset):
            for key in ("units", "long_name"):
                m[name].attrs[key] = about[key]


def external_storage(victim):
    def create(m, name, shape):
        space = h5py.h5s.create_simple(shape)
        plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plan.set_external(str(victim).encode(), 0, h5py.h5f.UNLIMITED)
        h5py.h5d.create(m.id, name.encode(), h5py.h5t.STD_U8LE, space, plan)
    return create


def external_link(victim):
    return lambda m, name, shape: m.__setitem__(name, h5py.ExternalLink(str(victim), "/status"))


def virtual(victim):
    def create(m, name, shape):
        layout = h5py.VirtualLayout(shape=shape, dtype="u1")
        layout[...] = h5py.VirtualSource(str(victim), "status", shape=shape)
        m.create_virtual_dataset(name, layout)
    return create


def references(victim):
    return lambda m, name, shape: m.create_dataset(name, shape, dtype=h5py.ref_dtype)


def foreign_filter(victim):
    return lambda m, name, shape: m.create_dataset(name, shape, dtype="u1", chunks=shape, scaleoffset=4)


def vast_chunks(victim):
    return lambda m, name, shape: m.create_dataset(name, shape, dtype="u1", chunks=(2**10, 2**10, 2**10),
                                                   maxshape=(None, None, None))


def committed_type(victim):
    return lambda m, name, shape: m.__setitem__(name, np.dtype("u1"))


FOREIGN = [external_storage, external_link, virtual, references, foreign_filter, vast_chunks, committed_type]


@pytest.mark.parametrize("kind", FOREIGN, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("name", ["status", "jump_height", "more"])
def test_what_leads_out_of_the_file_is_refused_by_all_and_alters_nothing(kind, name, original, victim,
                                                                         tmp_path):
    path = tmp_path / "map.h5"
    shutil.copy(original, path)
    shutil.copy(original.parent / "spec.toml", tmp_path / "spec.toml")
    if name == "more":
        with h5py.File(path, "r+") as m:
            m.create_group("inner")
            kind(victim)(m, "inner/more", m["status"].shape)
    else:
        replaced(path, name, kind(victim))
    before = path.read_bytes(), victim.read_bytes()
    spec, part = tmp_path / "spec.toml", tmp_path / "other.h5.part"
    shutil.copy(path, part)
    for words, statuses in ((["info",
                              path], {3}), (["info", path, "--failed"], {3}), (["check", path], {1}), ([
                                  "sweep", spec, "-o", path, "--retry-failed"
                              ], {3}), (["sweep", spec, "-o", tmp_path / "other.h5", "--resume"], {3})):
        done = leapmap(*words)
        assert done.returncode in statuses and (done.stderr + done.stdout).count("\n") <= 3, (words,
                                                                                              done.stdout,
                                                                                              done.stderr)
        assert "refused" in done.stderr + done.stdout, (words, done.stdout, done.stderr)
    with pytest.raises(NotAMap, match="refused|damaged"):
        read_map(path)
    page = scripted("explorer", path)
    assert page.returncode == 2 and page.stderr.count("\n") == 1
    assert (path.read_bytes(), victim.read_bytes()) == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["map.h5", "other.h5.part", "spec.toml", "victim"]


def with_journal(content, writes, begin=None, size=None):
    """A file's bytes with a journal whose checksum is right."""
    journal = b"".join(
        struct.pack("<QQ", offset, length if length is not None else len(data)) + data
        for offset, length, data in writes)
    begin = len(content) if begin is None else begin
    journal += struct.pack("<16sQQI", b"leapmap journal\n", begin, len(content) if size is None else size, 0)
    return content + journal + struct.pack("<I", zlib.crc32((content + journal)[begin:]))


@pytest.fixture
def part(tmp_path):
    """What a stopped sweep left: two of its tiles."""
    (tmp_path / "spec.toml").write_text(SMALL)
    words = [
        PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--commit-interval", "0",
        "--threads", "1"
    ]
    part = tmp_path / "map.h5.part"
    for number in range(120, 200):
        env = dict(os.environ, LD_PRELOAD=os.environ["LEAPMAP_FAULTS"], FAULT_UNDER=str(tmp_path),
                   FAULT_NUMBER=str(number), FAULT_ERROR="ENOSPC")
        assert subprocess.run(words, env=env, capture_output=True).returncode == 3
        # not just then in the middle of a commit
        if part.exists() and b"leapmap journal" not in part.read_bytes()[-40:]:
            return part
        part.unlink(missing_ok=True)
    pytest.fail("no call left a part without a journal")


EVIL = {
    "a length of 2^31": ([(0, 2**31, b"12345678")], {}),
    "a length of 2^64 - 1": ([(0, 2**64 - 1, b"12345678")], {}),
    "an offset of 2^62": ([(2**62, None, b"12345678")], {}),
    "an offset past the end": ([(2**64 - 4, None, b"12345678")], {}),
    "a size of 2^62": ([(8, None, b"12345678")], {"size": 2**62}),
    "half a head": ([(8, None, b"12345678"), (1, 10**6, b"")], {}),
}


@pytest.mark.parametrize("kind", EVIL)
def test_a_journal_that_makes_no_sense_is_refused_in_one_line(kind, part):
    writes, more = EVIL[kind]
    part.write_bytes(with_journal(part.read_bytes(), writes, **more))
    before = part.read_bytes()
    told = limited(500, PROGRAM, "info", part)
    assert told.returncode == 3 and told.stderr.count("\n") == 1 and "journal" in told.stderr, told.stderr
    resumed = leapmap("sweep", part.parent / "spec.toml", "-o", part.parent / "map.h5", "--resume")
    assert resumed.returncode == 3 and resumed.stderr.count("\n") == 1, resumed.stderr
    with pytest.raises(NotAMap, match="journal"):
        read_map(part)
    assert part.read_bytes() == before


def test_a_pending_journal_is_read_as_if_it_were_made_in_python_too(part):
    """Its writes put the file's first eight bytes right, and a word of an axis."""
    whole = part.read_bytes()
    with h5py.File(part) as p:
        place = p["slope"].id.get_offset()
        slope, heights = p["slope"][()], p["jump_height"][()]
    broken = bytearray(whole)
    broken[:8] = b"otherwis"
    broken[place:place + 8] = struct.pack("<d", 9.0)
    part.write_bytes(
        with_journal(bytes(broken), [(0, None, whole[:8]), (place, None, whole[place:place + 8])]))
    m = read_map(part)
    assert (m.dims["slope"] == slope).all() and not m.whole
    assert np.array_equal(m.fields["jump_height"], heights, equal_nan=True)
    assert leapmap("info", part).returncode == 0


def test_a_small_file_that_claims_much_takes_no_memory(original, tmp_path):
    def claim(m):
        del m["slope"]
        axis = m.create_dataset("slope", (10**9,), dtype="f8")
        axis.make_scale("slope")
        axis.attrs["units"] = "rad"
    path = tmp_path / "vast.h5"
    shutil.copy(original, path)
    with h5py.File(path, "r+") as m:
        claim(m)
    for words in ([PROGRAM, "info", path], [PROGRAM, "check",
                                            path], ["/usr/bin/python3", TOP / "analysis/explorer", path]):
        done = limited(900, *words)
        assert done.returncode in (1, 2, 3) and (
            done.stderr + done.stdout).count("\n") <= 2 and "bytes for" in done.stderr + done.stdout, (
                words, done.stderr)


def test_devices_pipes_and_the_specs_own_files_are_not_replaced(tmp_path):
    spec = tmp_path / "spec.toml"
    spec.write_text(SMALL)
    (tmp_path / "designs.csv").write_text("slope\n0.4\n")
    (tmp_path / "list.toml").write_text('[design]\npoints = "designs.csv"\n')
    os.mkfifo(tmp_path / "pipe")
    os.mknod(tmp_path / "null", 0o666 | 0o020000, os.makedev(1, 3))
    (tmp_path / "notes.txt").write_text("precious")
    before = {p.name: p.lstat() for p in tmp_path.iterdir()}
    for target in ("pipe", "null", "notes.txt", "spec.toml"):
        done = leapmap("sweep", spec, "-o", tmp_path / target, "--overwrite")
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (target, done.stderr)
    done = leapmap("sweep", tmp_path / "list.toml", "-o", tmp_path / "designs.csv", "--overwrite")
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert leapmap("hop", "--trace", tmp_path / "null").returncode == 2
    after = {p.name: p.lstat() for p in tmp_path.iterdir()}
    assert {k: (v.st_ino, v.st_size)
            for k, v in before.items()} == {k: (v.st_ino, v.st_size) for k, v in after.items()}
    for words in ([PROGRAM, "info", tmp_path / "pipe"], [PROGRAM, "check", tmp_path / "pipe"], [
            "/usr/bin/python3", TOP / "analysis/explorer", tmp_path / "pipe"
    ]):
        assert limited(2000, *words).returncode == 2, words


def test_the_explorer_spares_its_own_map_and_the_older_page(original, tmp_path):
    path, link = tmp_path / "map.h5", tmp_path / "link.html"
    shutil.copy(original, path)
    link.symlink_to(path)
    refused = scripted("explorer", path, "-o", link)
    assert refused.returncode == 2 and path.read_bytes() == original.read_bytes()
    page = tmp_path / "page.html"
    page.write_text("the older page")
    full = subprocess.run(
        ["/usr/bin/python3", str(TOP / "analysis/explorer"),
         str(path), "-o", str(page)], capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
    assert full.returncode == 2 and full.stderr.count("\n") == 1 and page.read_text() == "the older page"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["link.html", "map.h5", "page.html"]


@pytest.mark.parametrize("what,change", [
    ("NaN in its spec", lambda m: m.attrs.__setitem__(
        "spec", m.attrs["spec"].replace("release_spin = 0.0", "release_spin = nan"))),
    ("mu of 1e200",
     lambda m: m.attrs.__setitem__("spec", m.attrs["spec"].replace("mu_static = 0.5", "mu_static = 1e200"))),
    ("an axis of a strange name", lambda m: (m.move("slope", "$\\frac{$"))),
    ("a runway of a million turns",
     lambda m: m.attrs.__setitem__("spec", m.attrs["spec"].replace("runway = 5.0", "runway = 1000000.0"))),
])
def test_a_strange_map_is_one_line_and_no_traceback(what, change, original, tmp_path):
    path = tmp_path / "map.h5"
    shutil.copy(original, path)
    with h5py.File(path, "r+") as m:
        change(m)
    scripts = ["explorer"
               ] if "runway" in what else ["explorer", "design_chart.py", "status_chart.py", "cut_chart.py"]
    for script in scripts:
        done = scripted(script, path, "-o", tmp_path / "out")
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (script, done.stderr)


def test_texts_of_a_map_give_a_terminal_no_orders(original, tmp_path):
    path = tmp_path / "map.h5"
    shutil.copy(original, path)
    with h5py.File(path, "r+") as m:
        for name in ("title", "host", "date", "method", "program_version"):
            m.attrs[name] = "\x1b]0;owned\x07\x9b31m\u009b2J"
        m["jump_height"].attrs["units"] = "\x1b[2J"
        m.attrs["spec"] = "# \x1b[2J\n" + m.attrs["spec"]
    for words in (["info", path], ["info", path, "--spec"], ["check", path], ["info", path, "--failed"]):
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True)
        assert not any(b < 32 and b not in (9, 10) for b in done.stdout + done.stderr), words
        assert b"\xc2\x9b" not in done.stdout + done.stderr
    assert "\\x1b" in leapmap("info", path).stdout


def test_every_flipped_bit_of_a_finished_map_is_found_and_told(original, tmp_path):
    whole = original.read_bytes()
    path = tmp_path / "map.h5"
    bits = random.Random(3)
    with h5py.File(original) as m:
        chunk = m["jump_height"].id.get_chunk_info(1)
    told_where = 0
    for flip in [(chunk.byte_offset + 17, 3), (chunk.byte_offset + chunk.size - 1, 0),
                 *((bits.randrange(len(whole) - 32), bits.randrange(8)) for _ in range(40))]:
        damaged = bytearray(whole)
        damaged[flip[0]] ^= 1 << flip[1]
        path.write_bytes(damaged)
        done = leapmap("check", path)
        assert done.returncode == 1 and done.stdout.startswith("WRONG"), (flip, done.stdout, done.stderr)
        told_where += "in chunk" in done.stdout
        retried = leapmap("sweep", original.parent / "spec.toml", "-o", path, "--retry-failed")
        assert retried.returncode == 3 and path.read_bytes() == damaged, (flip, retried.stderr)
    assert told_where >= 2
    path.write_bytes(whole[:-1000])
    assert leapmap("check", path).returncode == 1
    path.write_bytes(whole)
    done = leapmap("check", path)
    assert done.returncode == 0 and "264 designs" in done.stdout


def test_check_finds_wrong_numbers_whose_checksums_are_right(original, tmp_path):
    path = tmp_path / "map.h5"
    for name, value, told in (("jump_height", 0.7, "differ by more than"),
                              ("status", 2, "the number of designs with each status differs"),
                              ("candidates", 9, "the stored status"), ("jump_height", 2e303,
                                                                       "2e+303"), ("status", 77, "holds 77")):
        shutil.copy(original, path)
        with h5py.File(path, "r+") as m:
            del m.attrs["tiles_checksum"]
            place = tuple(int(i[0]) for i in np.nonzero(m["status"][()] == 1))
            m[name][place] = value
        done = leapmap("check", path, "--sample", 1000)
        assert done.returncode == 1 and told in done.stdout, (name, done.stdout)


def test_memory_stays_within_what_the_dry_run_promises(tmp_path):
    spec = tmp_path / "spec.toml"
    spec.write_text(
        SMALL.replace("count = 12", "count = 150").replace("count = 11", "count = 300").replace(
            "audit = 0.05", "audit = 0.5"))
    plan = leapmap("sweep", spec, "-o", tmp_path / "map.h5", "--dry-run").stdout
    promised = {}
    for line in plan.splitlines():
        if line.startswith("memory"):
            for promise in line.removeprefix("memory").split(";"):
                number, unit = promise.strip().removeprefix("at most ").split(" ")[:2]
                promised[promise.split("for ")[1].strip()] = float(number) * {"MB": 1e6, "GB": 1e9}[unit]
    assert set(promised) == {"the sweep with its cross-check", "leapmap info", "the explorer"}, plan
    for name, words in (("the sweep with its cross-check", [
            PROGRAM, "sweep", spec, "-o", tmp_path / "map.h5", "--quiet"
    ]), ("leapmap info", [PROGRAM, "info", tmp_path / "map.h5"]), ("the explorer", [
            "/usr/bin/python3", TOP / "analysis/explorer", tmp_path / "map.h5"
    ])):
        process = subprocess.Popen([str(w) for w in words], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        used = 0  # the kernel's high-water mark; what wait4 tells begins with the memory of this interpreter
        while process.poll() is None:
            for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
                used = int(line.split()[1]) * 1024 if line.startswith("VmHWM") else used
            time.sleep(0.002)
        assert process.returncode == 0 and 1e7 < used < promised[name], (name, used, promised)


def foreign_file(path, kind):
    """A file of somebody else's, such as lies around where maps are made."""
    if kind == "text":
        path.write_text("precious")
    elif kind == "zeros":
        path.write_bytes(bytes(8) + b"an image of a disk")
    else:
        with h5py.File(path, "w") as file:
            if kind == "lzf":
                file.create_dataset("x", data=np.arange(1000), compression="lzf")
            elif kind == "link":
                file["x"] = h5py.ExternalLink("elsewhere.h5", "/x")


@pytest.mark.parametrize("kind", ["text", "zeros", "lzf", "link", "bare"])
def test_other_files_are_neither_replaced_nor_emptied(kind, original, tmp_path):
    spec = tmp_path / "spec.toml"
    spec.write_text(SMALL)
    shutil.copy(original, tmp_path / "map.h5")
    foreign_file(tmp_path / "x", kind)
    content = (tmp_path / "x").read_bytes()
    for place, words in (("other.h5", ["sweep", spec, "-o", tmp_path / "other.h5", "--overwrite"]),
                         ("trace.h5", ["hop", "--trace", tmp_path / "trace.h5"]), ("side.h5.part", [
                             "sweep", spec, "-o", tmp_path / "side.h5", "--overwrite"
                         ]), ("t.h5.part", ["hop", "--trace", tmp_path / "t.h5"]), ("map.h5.retry", [
                             "sweep", spec, "-o", tmp_path / "map.h5", "--retry-failed"
                         ])):
        if kind == "zeros" and place.endswith((".part", ".retry")):
            continue  # so begins an unfinished file that was never flushed
        (tmp_path / place).write_bytes(content)
        done = leapmap(*words)
        assert done.returncode in (2, 3) and done.stderr.count("\n") == 1, (place, done.stderr)
        assert (tmp_path / place).read_bytes() == content, place
        (tmp_path / place).unlink()
    if kind in ("text", "zeros", "bare"):
        (tmp_path / "page.html").write_bytes(content)
        assert scripted("explorer", tmp_path / "map.h5", "-o", tmp_path / "page.html").returncode == 2
        assert (tmp_path / "page.html").read_bytes() == content


def test_a_trace_leaves_the_unfinished_map_of_its_name_and_a_link_in_place(part, tmp_path):
    before = part.read_bytes()
    done = leapmap("hop", "--trace", part.parent / "map.h5")
    assert done.returncode == 2 and part.read_bytes() == before
    assert leapmap("hop", "--trace", tmp_path / "real.h5").returncode == 0
    (tmp_path / "link.h5").symlink_to(tmp_path / "real.h5")
    assert leapmap("hop", "--slope", "0.3", "--trace", tmp_path / "link.h5").returncode == 0
    assert (tmp_path / "link.h5").is_symlink()


def test_retry_takes_no_damage_for_values(tmp_path):
    failing = SMALL.replace("audit = 0.05", 'method = "gsl-rk8pd"\nmax_steps = 40\naudit = 0')
    path = sweep(tmp_path, failing)
    with h5py.File(path, "r+") as m:  # whose checksums HDF5 puts right, and the seal goes
        m["jump_height"][3, 3, 1] *= 1.5
    before = path.read_bytes()
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", path, "--retry-failed")
    assert done.returncode == 3 and "not what was written" in done.stderr and path.read_bytes() == before
    assert os.listdir(tmp_path) == sorted(["map.h5", "spec.toml"]) or sorted(
        os.listdir(tmp_path)) == ["map.h5", "spec.toml"]


def test_filters_twice_texts_without_end_and_holes_without_end_are_refused(original, tmp_path):
    def deflated_twice(m):
        del m["status"]
        plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plan.set_chunk((12, 11, 2))
        plan.set_deflate(9)
        plan.set_deflate(9)
        h5py.h5d.create(m.id, b"status", h5py.h5t.STD_U8LE, h5py.h5s.create_simple((12, 11, 2)), plan)

    def texts(m):
        m.create_dataset("words", data=["x" * 10**5] * 10, dtype=h5py.string_dtype())

    def holes(m):
        m.attrs["tiles_done"] = 0
        for name in ("more", "and_more"):
            m.create_dataset(name, (12, 11, 10**7), dtype="u1", chunks=(12, 11, 100))
    for change in (deflated_twice, texts, holes):
        path = tmp_path / "map.h5"
        shutil.copy(original, path)
        with h5py.File(path, "r+") as m:
            change(m)
        with pytest.raises(NotAMap, match="refused"):
            read_map(path)
        done = limited(600, PROGRAM, "info", path)
        assert done.returncode == 3, (change, done.stdout)


def test_labels_of_others_are_escaped_and_none_is_longer_than_ours(tmp_path):
    (tmp_path / "designs.csv").write_text("label,slope\none,0.4\ntwo,0.5\n")
    path = sweep(tmp_path, '[design]\npoints = "designs.csv"\n')
    for labels, told in ((["\x1b[2J", "two"], "\\x1b[2J"), (["x" * 10**6] * 2, "labels"), (["one"], "label"),
                         ([1.0, 2.0], "not a row of texts")):
        with h5py.File(path, "r+") as m:
            del m["label"]
            kind = np.float64 if isinstance(labels[0], float) else h5py.string_dtype()
            m.create_dataset("label", data=labels, dtype=kind).dims[0].attach_scale(m["design"])
            m["label"].attrs.update(units="1", long_name="name of the design, as its list has it")
        done = leapmap("info", path)
        assert told in done.stdout + done.stderr and "\x1b" not in done.stdout, (labels, done.stdout,
                                                                                 done.stderr)
        assert done.returncode == (0 if "x1b" in told else 3)
        assert leapmap("check", path).returncode == 1


def test_counts_that_make_no_sense_are_damage(original, tmp_path):
    for name, value in (("status_counts", [2**62] * 7), ("status_counts", [-1] * 7),
                        ("audit_first_mismatch", 2**61), ("audit_designs", -5)):
        path = tmp_path / "map.h5"
        shutil.copy(original, path)
        with h5py.File(path, "r+") as m:
            m.attrs[name] = np.array(value, "i8")
        done = leapmap("info", path) if name == "status_counts" else leapmap(
            "sweep", original.parent / "spec.toml", "-o", path, "--resume")
        assert (done.returncode in (0, 3)) if name == "status_counts" else done.returncode == 3, (name, value,
                                                                                                  done.stdout)
        assert leapmap("check", path).returncode == 1


def test_check_says_where_or_that_no_value_is_touched(original, tmp_path):
    whole = original.read_bytes()
    damaged = bytearray(whole)
    damaged[-1] ^= 1  # of the seal itself
    (tmp_path / "map.h5").write_bytes(damaged)
    done = leapmap("check", tmp_path / "map.h5")
    assert done.returncode == 1, done.stdout
    assert "hold no value" in done.stdout, done.stdout
    assert "right    " not in done.stdout, done.stdout
    with h5py.File(tmp_path / "bare.h5", "w") as file:
        file.attrs["filetype"] = "leapmap map"
    done = leapmap("check", tmp_path / "bare.h5")
    assert done.returncode == 1 and "WRONG" in done.stdout
    assert leapmap("check", tmp_path / "nowhere.h5").returncode == 3


def bomb(dataset, mebibytes=256):
    """A chunk of zeros without end, deflated, in place of the first one."""
    raw = zlib.compress(bytes(mebibytes * 2**20), 9)
    sums = dataset.fletcher32
    dataset.id.write_direct_chunk((0,) * dataset.ndim, raw + (b"\0" * 4 if sums else b""))


def test_a_chunk_that_inflates_beyond_its_values_is_refused(original, tmp_path):
    path = tmp_path / "bomb.h5"
    shutil.copy(original, path)
    with h5py.File(path, "r+") as m:
        for name in ("jump_height", "jump_time", "jump_angle"):
            bomb(m[name])
    begin = time.monotonic()
    for command in (["info", path], ["check", path], ["boundaries", path]):
        done = limited(300, PROGRAM, *command)
        assert "Traceback" not in done.stderr and "memory" not in done.stderr and (
            command[0] == "boundaries" or done.returncode != 0), done.stderr
    with pytest.raises(NotAMap, match="inflates"):
        read_map(path)
    assert time.monotonic() - begin < 20


def test_chunks_beyond_the_map_and_groups_without_end_are_refused_at_once(original, tmp_path):
    wide, deep = tmp_path / "wide.h5", tmp_path / "deep.h5"
    shutil.copy(original, wide)
    shutil.copy(original, deep)

    def create(m, name, shape):
        m.create_dataset(name, shape, chunks=(512, ) * len(shape), maxshape=(None, ) * len(shape), dtype="f8",
                         compression=1)
    replaced(wide, "jump_height", create)
    with h5py.File(deep, "r+") as m:
        group = m.id
        for _ in range(2000):
            group = h5py.h5g.create(group, b"g")
    for path, word in ((wide, "chunks"), (deep, "nested")):
        begin = time.monotonic()
        for command in ("info", "check", "boundaries"):
            done = limited(300, PROGRAM, command, path)
            assert done.returncode != 0 and word in done.stdout + done.stderr, (command, done.stdout,
                                                                                done.stderr)
        assert time.monotonic() - begin < 5


def test_texts_without_end_are_refused_before_memory_is_filled(tmp_path):
    (tmp_path / "wide.csv").write_text(",".join(f"c{i}" for i in range(500_000)) + "\n1\n")
    begin = time.monotonic()
    for command in (["hop", "/dev/zero"], ["sweep", "/dev/zero", "--dry-run"], ["fit", "/dev/zero"], [
            "sweep", "--dry-run", "--points", "/dev/zero"
    ], ["sweep", "--dry-run", "--points", tmp_path / "wide.csv"], ["fit", tmp_path / "wide.csv"]):
        done = limited(500, PROGRAM, *command)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and len(
            done.stderr) < 2000, done.stderr[:300]
    assert time.monotonic() - begin < 20
