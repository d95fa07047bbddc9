#include "common/model_reader/process_limits.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <vector>

namespace runstone {
namespace {

constexpr rlim_t kOpenFilesMax = 32;

Unexpected<std::string> cannot(const char* what) {
  return failure(std::string("the reader cannot ") + what + ": " + std::strerror(errno));
}

/// Lowers a limit. One that is lower already stays.
bool lower_limit(__rlimit_resource kind, rlim_t soft, rlim_t hard) {
  rlimit limit{};
  if (::getrlimit(kind, &limit) != 0) return false;
  if (limit.rlim_max > hard) limit.rlim_max = hard;
  if (limit.rlim_cur > soft) limit.rlim_cur = soft;
  return ::setrlimit(kind, &limit) == 0;
}

#if defined(__x86_64__)
constexpr std::uint32_t kFilteredArch = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kFilteredArch = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kFilteredArch = 0;
#endif

constexpr std::uint32_t kAllowedCalls[] = {
    // memory
    __NR_brk, __NR_mmap, __NR_munmap, __NR_mremap, __NR_mprotect, __NR_madvise, __NR_futex,
    // open files; standard output and error are pipes
    __NR_read, __NR_pread64, __NR_readv, __NR_write, __NR_writev, __NR_close, __NR_lseek,
    __NR_fstat, __NR_statx,
#ifdef __NR_newfstatat
    __NR_newfstatat,
#endif
    // opening them: ModelFolder and Landlock bound where
    437 /* openat2 */,
    // time, random numbers, and what the libraries ask about the process
    __NR_clock_gettime, __NR_clock_getres, __NR_gettimeofday, __NR_getrandom, __NR_getpid,
    __NR_gettid, __NR_sched_yield, __NR_sched_getaffinity, __NR_getrusage,
#ifdef __NR_time
    __NR_time,
#endif
    // the end
    __NR_exit, __NR_exit_group, __NR_rt_sigreturn, __NR_rt_sigaction, __NR_rt_sigprocmask,
    __NR_sigaltstack, __NR_restart_syscall};

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;

sock_filter load_word(std::size_t offset) {
  return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
sock_filter answer(std::uint32_t what) { return BPF_STMT(BPF_RET | BPF_K, what); }
/// Skips some instructions if the loaded word is `word`, others if it is not.
sock_filter if_word(std::uint32_t word, std::uint8_t skip_then, std::uint8_t skip_else) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word, skip_then, skip_else);
}
/// The offset of the low word of an argument. Both processors are little-endian.
constexpr std::size_t argument(std::size_t number) {
  return offsetof(seccomp_data, args) + 8 * number;
}

std::vector<sock_filter> call_filter() {
  std::vector<sock_filter> code = {load_word(offsetof(seccomp_data, arch)),
                                   if_word(kFilteredArch, 1, 0), answer(SECCOMP_RET_KILL_PROCESS),
                                   load_word(offsetof(seccomp_data, nr))};
  for (const std::uint32_t call : kAllowedCalls) {
    code.push_back(if_word(call, 0, 1));
    code.push_back(answer(kAllow));
  }
  // openat() for reading, where there is no openat2().
  constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
  code.push_back(if_word(__NR_openat, 0, 4));
  code.push_back(load_word(argument(2)));
  code.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kWriting, 1, 0));
  code.push_back(answer(kAllow));
  code.push_back(answer(kRefuse));
  // abort()
  code.push_back(if_word(__NR_tgkill, 0, 4));
  code.push_back(load_word(argument(0)));
  code.push_back(if_word(static_cast<std::uint32_t>(::getpid()), 0, 1));
  code.push_back(answer(kAllow));
  code.push_back(answer(kRefuse));
  code.push_back(answer(kRefuse));
  return code;
}

}  // namespace

Result<void, std::string> limit_process(const ProcessLimits& limits) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return cannot("give up new privileges");
  ::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
  // A program that is killed leaves no reader behind. The thread that started this one waits for it.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
#ifndef RUNSTONE_SANITIZED
  if (!lower_limit(RLIMIT_AS, limits.memory_bytes, limits.memory_bytes))
    return cannot("limit its memory");
#endif
  if (!lower_limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1)) return cannot("limit its time");
  if (!lower_limit(RLIMIT_NOFILE, kOpenFilesMax, kOpenFilesMax) ||
      !lower_limit(RLIMIT_FSIZE, 0, 0) || !lower_limit(RLIMIT_CORE, 0, 0))
    return cannot("limit its files");
  return {};
}

Result<void, std::string> refuse_other_calls() {
  if (kFilteredArch == 0) return {};
  std::vector<sock_filter> code = call_filter();
  sock_fprog program{static_cast<unsigned short>(code.size()), code.data()};
  if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    return cannot("filter its system calls (seccomp)");
  return {};
}

}  // namespace runstone
