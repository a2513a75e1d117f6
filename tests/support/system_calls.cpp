// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/system_calls.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>

extern "C" {
ssize_t __real_pwrite(int descriptor, const void* bytes, size_t count, off_t offset);
int __real_fsync(int descriptor);
int __real_ftruncate(int descriptor, off_t size);

ssize_t __wrap_pwrite(int descriptor, const void* bytes, size_t count, off_t offset);
int __wrap_fsync(int descriptor);
int __wrap_ftruncate(int descriptor, off_t size);
}

namespace leapmap::testing {

std::function<void(const SystemCall&)> before_system_call;

bool dies_at_call(long number, const std::function<void()>& f) {
  constexpr int killed = 17, ended = 0;
  const pid_t child = ::fork();
  if (child == 0) {
    static std::atomic<long> left;  // of calls by any thread
    left = number;
    before_system_call = [](const SystemCall& call) {
      if (left-- > 0) return;
      if (call.kind == SystemCall::Kind::write && !call.bytes.empty())
        static_cast<void>(__real_pwrite(call.descriptor, call.bytes.data(), call.bytes.size() / 2,
                                        static_cast<off_t>(call.offset)) < 0);
      ::_exit(killed);
    };
    f();
    ::_exit(ended);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == killed || WEXITSTATUS(status) == ended))
      << "status " << status;
  return WIFEXITED(status) && WEXITSTATUS(status) == killed;
}

}  // namespace leapmap::testing

using leapmap::testing::before_system_call;
using leapmap::testing::SystemCall;

ssize_t __wrap_pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  if (before_system_call)
    before_system_call({SystemCall::Kind::write,
                        descriptor,
                        static_cast<std::uint64_t>(offset),
                        {static_cast<const std::byte*>(bytes), count}});
  return __real_pwrite(descriptor, bytes, count, offset);
}

int __wrap_fsync(int descriptor) {
  if (before_system_call) before_system_call({SystemCall::Kind::sync, descriptor, 0, {}});
  return __real_fsync(descriptor);
}

int __wrap_ftruncate(int descriptor, off_t size) {
  if (before_system_call)
    before_system_call({SystemCall::Kind::truncate, descriptor, static_cast<std::uint64_t>(size), {}});
  return __real_ftruncate(descriptor, size);
}
