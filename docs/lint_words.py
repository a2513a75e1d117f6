#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check the words that a user meets: pages, help, messages, docstrings, public headers, the texts of the
page.

    docs/lint_words.py            every text of the repository; exit status 1 if something is found
    docs/lint_words.py FILE ...   these files only

It reports phrases of the hunt list, which hide what happens, and sentences of more than thirty words. If
codespell is installed, it reports misspellings too. Code, file names and names in `backquotes` are not read.
"""
import argparse
import ast
import re
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
MOST_WORDS = 30

# Each phrase and what to write in its place.
HUNT = [
    (re.compile(pattern, re.I), instead)
    for pattern, instead in (
        (r"\b(tell|tells|told)\b", "report, show, determine"),
        (r"\bas (made|drawn)\b|\bmade hoops?\b|\bhoops? made\b", "manufactured, nominal, samples"),
        (r"\blook(s|ed|ing)? (at|for|through)\b", "evaluate, search"),
        (r"\bgo(es|ing)? on\b|\bgone on\b|\banew\b|\bbegun\b", "continue, resume, restart"),
        (r"\bha(s|ve) no use\b", "has no effect"),
        (r"\b(so|as) (many|much)\b", "the number of"),
        (r"\bshares? (of|that)\b", "fraction"),
        (r"\b(nobody|somebody)\b|\bwithout a word\b", "the passive; silently"),
        (r"\ba hair\b|\bfor ever\b|\bforetells?\b|, say\b", "slightly, indefinitely, predict, for example"),
        (r"\bis let\b|\blets? pass\b", "is ignored"),
        (r"(?:^|[.;:] )of (one|no|none|each)\b", "another order of words"),
        (r"\bwhere (it|they|there|that|no|an?)\b", "if, when"),
        (r"\bto rounding\b", "to machine precision"),
        (r"\bby the (block|panel|piece)\b", "one block at a time"),
        (r"\ba hoop of one's own\b", "your own hoop"),
    )
]


def paragraphs(text, first=1):
    """Paragraphs of a text, each with the number of its first line."""
    lines, start = [], first
    for number, line in enumerate(text.splitlines() + [""], first):
        if line.strip():
            if not lines:
                start = number
            lines.append(line.strip())
        elif lines:
            yield start, " ".join(lines)
            lines = []


def plain(text):
    """Prose without code spans, links' addresses and marks."""
    text = re.sub(r"\{[a-z:]+\}`[^`]*`|``.*?``|`[^`]*`", "CODE", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[*_]{1,2}(?=\S)|(?<=\S)[*_]{1,2}", "", text)


def markdown(text):
    """Paragraphs, list items, headings and cells of a page; code is left out."""
    kept, fence = [], ""
    for line in text.splitlines():
        mark = re.match(r" *(`{3,}|:{3,}|~{3,})", line)
        if fence:
            if mark and mark[1].startswith(fence) and line.strip() == mark[1]:
                fence = ""
            kept.append("")
        elif mark and mark[1][0] != ":":
            fence = mark[1]
            kept.append("")
        elif (
            mark
            or re.match(r"( {4,}|\t)(?![-*] )", line)
            and not (kept and re.match(r" *([-*]|\d+\.) ", kept[-1]))
            or re.match(r"<!--|\(.*\)=$|[-=|: ]+$|:\w+:", line)
        ):
            kept.append("")
        elif line.startswith("|"):
            kept.append("\0" + line)
        elif re.match(r"#+ ", line):
            kept.append("\0" + line.lstrip("# "))
        else:
            kept.append(line)
    for number, line in enumerate(kept, 1):
        if line.startswith("\0|"):
            for cell in line[1:].strip("|").split("|"):
                yield number, plain(cell.strip())
            kept[number - 1] = ""
        elif line.startswith("\0"):
            yield number, plain(line[1:])
            kept[number - 1] = ""
        elif re.match(r" *([-*]|\d+\.) ", line) and number > 1 and kept[number - 2]:
            kept[number - 1] = "\n" + re.sub(r"^ *([-*]|\d+\.) ", "", line)
    for number, text in paragraphs("\n".join(line.replace("\n", "\0") for line in kept)):
        for part in text.split("\0"):
            yield number, plain(re.sub(r"^ *([-*]|\d+\.) ", "", part))


def literals(text):
    """String literals of C++ or JavaScript that hold a phrase, neighbours joined."""
    token = re.compile(
        r'R"\((.*?)\)"|"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`|\'((?:[^\'\\\n]|\\.)*)\''
        r"|//[^\n]*|/\*.*?\*/|\S",
        re.S,
    )
    joined, start, at = [], 1, 0
    for match in token.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        value = next((g for g in match.groups() if g is not None), None)
        if value is not None:
            if not joined:
                start = line
            joined.append(value)
        elif not match[0].startswith(("//", "/*")) and joined:
            yield start, "".join(joined)
            joined = []


def c_source(text):
    text = re.sub(r"(?m)^#include.*$", "", text)
    for number, value in literals(text):
        value = re.sub(r"\$\{[^{}]*\}", "CODE", re.sub(r"\\n", "\n", value).replace('\\"', '"'))
        if " " in value.strip():
            for block in re.split(r"\n\s*\n|\n(?=  )", value):
                yield number, plain(" ".join(block.split()))


def header(text):
    """The documentation of a public header: its comments of three slashes."""
    block, start = [], 0
    for number, line in enumerate(text.splitlines() + [""], 1):
        mark = re.search(r"///<? ?(.*)$", line)
        continues = (
            mark
            and block
            and (line.strip().startswith("///<") or line.strip().startswith("/// ") or not mark[1])
        )
        if block and not continues:
            yield start, plain(re.sub(r"@\w+ ?(\{[^}]*\})?", "", " ".join(block)))
            block = []
        if mark:
            if not mark[1] or re.match(r"@(code|endcode)", mark[1]):
                if block:
                    yield start, plain(" ".join(block))
                block = []
                continue
            if not block or re.match(r"[@-]", mark[1]):
                if block:
                    yield start, plain(re.sub(r"@\w+ ?", "", " ".join(block)))
                block, start = [], number
            block.append(mark[1])


def python(text, is_module=False):
    """Strings that hold a phrase, and docstrings: of a script the one that --help prints, of a module all."""
    tree = ast.parse(text)
    documented = {
        id(node.body[0].value): getattr(node, "name", "")
        for node in ast.walk(tree)
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))
        and ast.get_docstring(node, clean=False)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            value = "".join(part.value if isinstance(part, ast.Constant) else "CODE" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            value = node.value
        else:
            continue
        if documented.get(id(node), "") and (documented[id(node)].startswith("_") or not is_module):
            continue  # what developers of the charts read
        if id(node) in documented:
            prose = re.sub(r"(?m)^\s*(>>>|\.\.\.).*\n(?:(?!\s*(?:>>>|\.\.\.))\s*\S.*\n)*", "\n", value)
            prose = re.sub(r"(?m)^ {4,}\S+ : .*$|^\s*-{3,}$", "", prose)
            for number, part in paragraphs(prose, node.lineno):
                yield number, plain(part)
        elif " " in value.strip():
            yield node.lineno, plain(" ".join(value.split()))


def html(text):
    text = re.sub(r"<(script|style)\b.*?</\1>", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    for match in re.finditer(r'(?:title|placeholder|aria-label|alt)="([^"]*)"|>([^<>]*)<', text):
        value = match[1] or match[2] or ""
        if " " in value.strip():
            yield text.count("\n", 0, match.start()) + 1, plain(" ".join(value.split()))


READERS = {
    ".md": markdown,
    ".cpp": c_source,
    ".hpp": c_source,
    ".js": c_source,
    ".py": python,
    ".html": html,
    ".toml": lambda text: (
        (n, plain(line.partition("#")[2])) for n, line in enumerate(text.splitlines(), 1) if "#" in line
    ),
}


def texts(path):
    """Line and text of everything that a user reads of a file."""
    text = path.read_text(encoding="utf-8")
    if path.parent == TOP / "src/leapmap":
        yield from header(text)
    reader = READERS.get(path.suffix) or (python if text.startswith("#!/usr/bin/python3") else None)
    if reader is python:
        yield from python(text, path.is_relative_to(TOP / "src/python/leapmap"))
    elif reader:
        yield from reader(text)


def user_files():
    files = subprocess.run(
        [
            "git",
            "-C",
            str(TOP),
            "ls-files",
            "--cached",
            "--others",
            "--exclude-standard",
            "*.md",
            "src",
            "analysis",
            "sweeps",
        ],
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split()
    for name in sorted(set(files)):
        path = TOP / name
        if not path.exists() or name.startswith(("tests/", "analysis/boost_rival", "src/python/stubs.py")):
            continue
        if path.suffix in READERS or name == "analysis/explorer":
            yield path


def found_in(path):
    for line, text in texts(path):
        for pattern, instead in HUNT:
            for match in pattern.finditer(text):
                around = text[max(0, match.start() - 40) : match.end() + 40]
                yield line, f"'{match[0].strip('.;: ')}' in \"... {around} ...\"; write: {instead}"
        for sentence in re.split(r"(?<=[.!?:;])\s+", text):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > MOST_WORDS and not re.search(r"(\S+, ){12}", sentence):
                begin = " ".join(words[:8])
                yield line, f'{len(words)} words in one sentence, "{begin} ..."; at most {MOST_WORDS}'


def misspelt(paths):
    if not shutil.which("codespell"):
        return []
    run = subprocess.run(
        ["codespell", "--ignore-words-list", "te,fo,nd,ba,ue,theses,ot", *map(str, paths)],
        capture_output=True,
        text=True,
        check=False,
    )
    return run.stdout.splitlines()


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", nargs="*", type=Path, help="default: every text of the repository")
    paths = [path.resolve() for path in parser.parse_args().files] or list(user_files())
    count = 0
    for path in paths:
        for line, problem in sorted(set(found_in(path))):
            print(f"{path.relative_to(TOP)}:{line}: {problem}")
            count += 1
    spelling = misspelt(paths)
    print(*spelling, sep="\n", end="\n" if spelling else "")
    count += len(spelling)
    print(f"{count} to rewrite in {len(paths)} files" if count else f"{len(paths)} files: nothing to rewrite")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
