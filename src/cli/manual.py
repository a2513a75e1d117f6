#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes leapmap's man page and bash completion from its own --help: manual.py PROGRAM FOLDER."""
import re
import subprocess
import sys
from pathlib import Path


def told(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def quoted(text):
    """Text as troff prints it, line by line."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\n".join(
        ("\\&" + line if line.startswith((".", "\\(aq")) else line) for line in escaped.splitlines())


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    top = told(program, "--help")
    version = told(program, "--version").split()[1]
    section = top.split("Commands:\n")[1].split("\n\n")[0]
    commands = re.findall(r"^  (\S+)\s{2,}(.*)$", section, re.M)
    helps = {name: told(program, name, "--help") for name, _ in commands}
    summary = " ".join(top.split("\n\n")[0].removeprefix("leapmap: ").split())
    lines = [
        f'.TH LEAPMAP 1 "" "leapmap {version}" "User Commands"', ".SH NAME", f"leapmap \\- {summary}",
        ".SH SYNOPSIS", ".B leapmap", ".I COMMAND", "[options]", ".SH DESCRIPTION", ".nf",
        quoted(top), ".fi"
    ]
    for name, text in helps.items():
        lines += [f".SH LEAPMAP {name.upper()}", ".nf", quoted(text), ".fi"]
    (folder / "leapmap.1").write_text("\n".join(lines) + "\n", encoding="utf-8")

    flags = {
        name: sorted(set(re.findall(r"^  (?:-\w, )?(--[a-z][a-z-]*)", text, re.M)))
        for name, text in helps.items()
    }
    cases = "\n".join(f'    {name}) words="{" ".join(words)}" ;;' for name, words in flags.items())
    (folder / "leapmap.bash").write_text(
        f'''# bash completion of leapmap: commands, their options, files
_leapmap() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" command="" word
  local words="{" ".join(name for name, _ in commands)} --help --version --instruction-set"
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$word" in {"|".join(name for name, _ in commands)}) command="$word"; break ;; esac
  done
  case "$command" in
{cases}
  esac
  if [[ -z "$command" || "$current" == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _leapmap leapmap
''', encoding="utf-8")


if __name__ == "__main__":
    main()
