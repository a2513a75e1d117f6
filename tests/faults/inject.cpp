// SPDX-License-Identifier: GPL-3.0-or-later
/// Makes one call of a program fail, or that and all after it: a library to be preloaded (LD_PRELOAD).
///
/// Counted are the calls that touch files below one folder, or memory, in the order they are made, from 0.
/// The environment says what is to happen:
///   FAULT_UNDER    the folder, absolute; unset: files are left alone
///   FAULT_MEMORY   "new": operator new is counted, and not files; "malloc": so is every allocation, those of
///                  libraries in C as well
///   FAULT_NUMBER   the call that fails; unset: none
///   FAULT_ERROR    EIO, ENOSPC, EINTR, EDQUOT, ENOLCK; short: half of the bytes; zero: none of them, without
///   an error;
///                  kill: the program is killed in place of the call
///   FAULT_STICKY   set: every call after it fails as well
///   FAULT_COUNT    a file that the number of calls is written to at the end
///   FAULT_WAITS    set: nothing is counted before the program calls begin_faults()
///   FAULT_TELLS    set: who asked for the memory that operator new did not get is written to standard error
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
}

namespace {

enum class Fault { none, error, short_count, zero_count, kill };

struct Plan {
  char under[4096] = "";
  size_t under_length = 0;
  bool news = false, mallocs = false, sticky = false, tells = false, ready = false;
  long number = -1;
  int error = EIO;
  Fault fault = Fault::error;
  char count[4096] = "";
};
Plan plan;
std::atomic<long> calls{0};
constexpr int most_descriptors = 4096;
std::atomic<bool> watched[most_descriptors];

void copy(char (&to)[4096], const char* from) {
  if (from) strncpy(to, from, sizeof to - 1);
}

[[gnu::constructor]] void read_plan() {
  copy(plan.under, getenv("FAULT_UNDER"));
  plan.under_length = strlen(plan.under);
  copy(plan.count, getenv("FAULT_COUNT"));
  const char* memory = getenv("FAULT_MEMORY");
  plan.news = memory && strcmp(memory, "new") == 0;
  plan.mallocs = memory && !plan.news;
  plan.sticky = getenv("FAULT_STICKY") != nullptr;
  plan.tells = getenv("FAULT_TELLS") != nullptr;
  if (const char* number = getenv("FAULT_NUMBER")) plan.number = strtol(number, nullptr, 10);
  if (const char* error = getenv("FAULT_ERROR")) {
    struct {
      const char* name;
      int value;
      Fault fault;
    } const known[] = {{"EIO", EIO, Fault::error},       {"ENOSPC", ENOSPC, Fault::error},
                       {"EINTR", EINTR, Fault::error},   {"EDQUOT", EDQUOT, Fault::error},
                       {"ENOLCK", ENOLCK, Fault::error}, {"short", 0, Fault::short_count},
                       {"zero", 0, Fault::zero_count},   {"kill", SIGKILL, Fault::kill}};
    for (const auto& k : known)
      if (strcmp(k.name, error) == 0) plan.error = k.value, plan.fault = k.fault;
  }
  plan.ready = getenv("FAULT_WAITS") == nullptr;
}

[[gnu::destructor]] void write_count() {
  if (plan.count[0] == '\0') return;
  char text[32];
  const int length = snprintf(text, sizeof text, "%ld\n", calls.load());
  const long file = syscall(SYS_openat, AT_FDCWD, plan.count, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  syscall(SYS_write, file, text, length);
  syscall(SYS_close, file);
}

/// What is to become of the call at hand, which is counted.
Fault next_call() {
  const long number = calls++;
  const bool fails = plan.number >= 0 && (plan.sticky ? number >= plan.number : number == plan.number);
  if (fails && plan.fault == Fault::kill) kill(getpid(), SIGKILL);
  return fails ? plan.fault : Fault::none;
}

bool is_below(const char* path) {
  if (!plan.ready || plan.news || plan.mallocs || plan.under_length == 0 || !path) return false;
  char absolute[8192];
  if (path[0] != '/') {
    char folder[4096];
    if (syscall(SYS_getcwd, folder, sizeof folder) < 0) return false;
    snprintf(absolute, sizeof absolute, "%s/%s", folder, path);
    path = absolute;
  }
  return strncmp(path, plan.under, plan.under_length) == 0 &&
         (path[plan.under_length] == '/' || path[plan.under_length] == '\0');
}

bool is_watched(int descriptor) {
  return descriptor >= 0 && descriptor < most_descriptors && watched[descriptor];
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Fails a call that knows no half ways.
bool fails() {
  if (next_call() != Fault::error) return false;
  errno = plan.error;
  return true;
}

/// A transfer of bytes: whole, in part, none, or an error.
template <class Transfer>
ssize_t transferred(int descriptor, size_t count, const Transfer& transfer) {
  switch (is_watched(descriptor) ? next_call() : Fault::none) {
    case Fault::error:
      errno = plan.error;
      return -1;
    case Fault::zero_count:
      return 0;
    case Fault::short_count:
      return transfer(count > 1 ? count / 2 : count);
    default:
      return transfer(count);
  }
}

int opened(int folder, const char* path, int flags, mode_t mode) {
  const bool below = is_below(path);
  if (below && fails()) return -1;
  const int descriptor = static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
  if (descriptor >= 0 && descriptor < most_descriptors) watched[descriptor] = below;
  return descriptor;
}

mode_t mode_in(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

#define FAULTY_OPEN(name)                          \
  int name(const char* path, int flags, ...) {     \
    va_list arguments;                             \
    va_start(arguments, flags);                    \
    const mode_t mode = mode_in(flags, arguments); \
    va_end(arguments);                             \
    return opened(AT_FDCWD, path, flags, mode);    \
  }
#define FAULTY_OPENAT(name)                                \
  int name(int folder, const char* path, int flags, ...) { \
    va_list arguments;                                     \
    va_start(arguments, flags);                            \
    const mode_t mode = mode_in(flags, arguments);         \
    va_end(arguments);                                     \
    return opened(folder, path, flags, mode);              \
  }

extern "C" {

void begin_faults() { plan.ready = true; }

FAULTY_OPEN(open)
FAULTY_OPEN(open64)
FAULTY_OPENAT(openat)
FAULTY_OPENAT(openat64)

int close(int descriptor) {
  const bool fault = is_watched(descriptor) && fails();
  if (descriptor >= 0 && descriptor < most_descriptors) watched[descriptor] = false;
  const int result = static_cast<int>(syscall(SYS_close, descriptor));  // as Linux does, also where it fails
  if (fault) errno = plan.error;
  return fault ? -1 : result;
}

ssize_t read(int descriptor, void* bytes, size_t count) {
  return transferred(descriptor, count, [&](size_t n) { return syscall(SYS_read, descriptor, bytes, n); });
}
ssize_t write(int descriptor, const void* bytes, size_t count) {
  return transferred(descriptor, count, [&](size_t n) { return syscall(SYS_write, descriptor, bytes, n); });
}
ssize_t pread64(int descriptor, void* bytes, size_t count, off64_t offset) {
  return transferred(descriptor, count,
                     [&](size_t n) { return syscall(SYS_pread64, descriptor, bytes, n, offset); });
}
ssize_t pread(int descriptor, void* bytes, size_t count, off_t offset) {
  return pread64(descriptor, bytes, count, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  return transferred(descriptor, count,
                     [&](size_t n) { return syscall(SYS_pwrite64, descriptor, bytes, n, offset); });
}
ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  return pwrite64(descriptor, bytes, count, offset);
}
int ftruncate64(int descriptor, off64_t size) {
  return is_watched(descriptor) && fails() ? -1 : static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}
int ftruncate(int descriptor, off_t size) { return ftruncate64(descriptor, size); }
int fsync(int descriptor) {
  return is_watched(descriptor) && fails() ? -1 : static_cast<int>(syscall(SYS_fsync, descriptor));
}
int fdatasync(int descriptor) {
  return is_watched(descriptor) && fails() ? -1 : static_cast<int>(syscall(SYS_fdatasync, descriptor));
}
int flock(int descriptor, int operation) {
  return is_watched(descriptor) && fails() ? -1 : static_cast<int>(syscall(SYS_flock, descriptor, operation));
}
int fstat(int descriptor, struct stat* status) {
  if (is_watched(descriptor) && fails()) return -1;
  return real<int(int, struct stat*)>("fstat")(descriptor, status);
}
int fstat64(int descriptor, struct stat64* status) {
  if (is_watched(descriptor) && fails()) return -1;
  return real<int(int, struct stat64*)>("fstat64")(descriptor, status);
}
int stat(const char* path, struct stat* status) {
  if (is_below(path) && fails()) return -1;
  return real<int(const char*, struct stat*)>("stat")(path, status);
}
int rename(const char* from, const char* to) {
  return is_below(from) && fails() ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return is_below(from) && fails()
             ? -1
             : static_cast<int>(syscall(SYS_renameat, from_folder, from, to_folder, to));
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  return is_below(from) && fails()
             ? -1
             : static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
int unlink(const char* path) {
  return is_below(path) && fails() ? -1 : static_cast<int>(syscall(SYS_unlink, path));
}
int mkdir(const char* path, mode_t mode) {
  return is_below(path) && fails() ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}

void* malloc(size_t size) {
  if (plan.ready && plan.mallocs && next_call() != Fault::none) return errno = ENOMEM, nullptr;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  if (plan.ready && plan.mallocs && next_call() != Fault::none) return errno = ENOMEM, nullptr;
  return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  if (plan.ready && plan.mallocs && next_call() != Fault::none) return errno = ENOMEM, nullptr;
  return __libc_realloc(old, size);
}

}  // extern "C"

namespace {

void* allocated(size_t size, size_t alignment = alignof(max_align_t)) {
  void* memory = nullptr;
  if (plan.ready && plan.news && next_call() != Fault::none) return nullptr;
  if (alignment <= alignof(max_align_t)) return malloc(size > 0 ? size : 1);
  return posix_memalign(&memory, alignment, size) == 0 ? memory : nullptr;
}

void* or_throw(void* memory) {
  if (!memory && plan.tells) {
    void* callers[64];
    backtrace_symbols_fd(callers, backtrace(callers, 64), STDERR_FILENO);
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(size_t size) { return or_throw(allocated(size)); }
void* operator new[](size_t size) { return or_throw(allocated(size)); }
void* operator new(size_t size, std::align_val_t alignment) {
  return or_throw(allocated(size, static_cast<size_t>(alignment)));
}
void* operator new[](size_t size, std::align_val_t alignment) {
  return or_throw(allocated(size, static_cast<size_t>(alignment)));
}
void* operator new(size_t size, const std::nothrow_t&) noexcept { return allocated(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return allocated(size); }
void operator delete(void* memory) noexcept { free(memory); }
void operator delete[](void* memory) noexcept { free(memory); }
void operator delete(void* memory, size_t) noexcept { free(memory); }
void operator delete[](void* memory, size_t) noexcept { free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { free(memory); }
void operator delete[](void* memory, size_t, std::align_val_t) noexcept { free(memory); }
