// SPDX-License-Identifier: GPL-3.0-or-later
/// The end of a program that gets no memory: one line and status 1, wherever that happens.
///
/// The libraries below cannot do without: HDF5 1.10 goes on with null pointers, toml++ allocates where
/// nothing may be thrown, and CLI11 has globals that allocate before main. To stop at once loses nothing,
/// because a file of ours is always as of its last commit.
#include <cxxabi.h>
#include <dlfcn.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <typeinfo>

namespace {

[[noreturn]] void end_without_memory() noexcept {
  constexpr std::string_view line = "leapmap: out of memory\n";
  static_cast<void>(::write(STDERR_FILENO, line.data(), line.size()) < 0);  // nowhere else to say so
  ::_exit(1);
}

/// An exception that nothing catches, for instance one that would leave a function that may throw none.
[[noreturn]] void end_of_uncaught() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  if (type && *type == typeid(std::bad_alloc)) end_without_memory();
  std::abort();
}

/// Before any global of the program is made.
[[gnu::constructor(101)]] void set_end_of_uncaught() { std::set_terminate(end_of_uncaught); }

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which bring a malloc of their own

namespace {

/// The allocation function that would have been called without ours.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void* or_end(void* memory, std::size_t bytes) {
  if (!memory && bytes > 0) end_without_memory();
  return memory;
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) noexcept {
  static auto* const allocate = next<void*(std::size_t)>("malloc");
  return or_end(allocate(bytes), bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
  static auto* const allocate = next<void*(std::size_t, std::size_t)>("calloc");
  return or_end(allocate(count, bytes), count > 0 ? bytes : 0);
}

void* realloc(void* old, std::size_t bytes) noexcept {
  static auto* const allocate = next<void*(void*, std::size_t)>("realloc");
  return or_end(allocate(old, bytes), bytes);
}
}

namespace {

/// Each of them is looked up now. While dlerror makes its message a first look-up would free what it is
/// about.
[[gnu::constructor(102)]] void look_up() {
  void* volatile memory = std::malloc(1);  // else the compiler would leave these calls out
  memory = std::realloc(memory, 2);
  std::free(memory);
  memory = std::calloc(1, 1);
  std::free(memory);
}

}  // namespace

#endif
