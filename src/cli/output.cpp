// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output.hpp"

#include <cstdio>

#include "support/posix.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {

void write_out(const std::string& raw) {
  const std::string text = printable(raw, "\n\t");
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    fail_with_errno("standard output", "cannot be written");
}

void flush_out() {
  if (std::fflush(stdout) != 0) fail_with_errno("standard output", "cannot be written");
}

void tell(const std::string& line) { std::fputs(("leapmap: " + printable(line) + "\n").c_str(), stderr); }

void tell_of_folder(const std::string& path) {
  tell(path +
       ": is complete and in its place, but its folder cannot be synced to disk: a power failure may undo "
       "that");
}

}  // namespace leapmap::cli
