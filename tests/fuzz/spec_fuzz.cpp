// SPDX-License-Identifier: GPL-3.0-or-later
/// Any text as a spec: it is read or refused with an InputError, and what is read says itself again.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "leapmap/errors.hpp"
#include "spec/spec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace leapmap;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  // The first line, if it holds "=", is what --set would say.
  const std::string_view first = input.substr(0, input.find('\n'));
  std::vector<std::string> overrides;
  if (first.starts_with("#set ")) overrides.emplace_back(first.substr(5));
  try {
    const Spec spec = parse_spec(input, "fuzz", overrides);
    std::size_t values = 0;
    for (const Axis& axis : spec.axes) values += axis.values.size();
    if (values > 2000) return 0;  // large axes are slow to write out, and no different
    const std::string text = resolved_text(spec);
    if (resolved_text(parse_spec(text, "resolved", {})) != text) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
