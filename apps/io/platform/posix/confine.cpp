#include "apps/io/platform/posix/confine.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>

namespace halflit::platform {

#ifdef __linux__

namespace {

// Landlock, as the kernel's documentation has it: Debian 11's headers lack it.
constexpr long kCreateRules = 444, kAddRule = 445, kRestrict = 446;
constexpr std::uint64_t kExecute = 1, kReadFile = 4, kReadFolder = 8;
constexpr std::uint64_t kAllOfFirstVersion = (1 << 13) - 1, kRefer = 1 << 13, kTruncate = 1 << 14;

struct Rules {
    std::uint64_t files;
};
#pragma pack(push, 1)
struct BelowFolder {
    std::uint64_t allowed;
    std::int32_t folder;
};
#pragma pack(pop)

void allow_reading(int rules, const char* path, bool is_folder) {
    const int folder = ::open(path, O_PATH | O_CLOEXEC);
    if (folder < 0) return;
    const BelowFolder rule{is_folder ? kExecute | kReadFile | kReadFolder : kReadFile, folder};
    (void)::syscall(kAddRule, rules, 1, &rule, 0);
    (void)::close(folder);
}

#if defined(__x86_64__) || defined(__aarch64__)
#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#endif

/// System calls of programs that read one file, compute with threads and write to a pipe. All others are refused: those that change
/// files, reach other processes or machines, or widen rights, and those that the kernel will have.
constexpr int kAllowed[] = {
    // streams and files
    SYS_read,
    SYS_readv,
    SYS_pread64,
    SYS_preadv,
    SYS_write,
    SYS_writev,
    SYS_pwrite64,
    SYS_close,
    436 /* close_range */,
    SYS_lseek,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_statfs,
    SYS_fstatfs,
    SYS_faccessat,
    439 /* faccessat2 */,
    SYS_readlinkat,
    SYS_getdents64,
    SYS_getcwd,
    SYS_chdir,
    SYS_umask,
    SYS_dup,
    SYS_dup3,
    SYS_pipe2,
    SYS_ppoll,
    SYS_pselect6,
    SYS_epoll_create1,
    SYS_epoll_ctl,
    SYS_epoll_pwait,
    SYS_eventfd2,
    SYS_memfd_create,
    SYS_fadvise64,
    SYS_fsync,
    SYS_fdatasync,
    // memory
    SYS_brk,
    SYS_mmap,
    SYS_munmap,
    SYS_mremap,
    SYS_mprotect,
    SYS_madvise,
    SYS_mincore,
    SYS_msync,
    SYS_membarrier,
    // the process itself
    SYS_execve,
    SYS_exit,
    SYS_exit_group,
    SYS_wait4,
    SYS_waitid,
    SYS_getpid,
    SYS_getppid,
    SYS_gettid,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
    SYS_getresuid,
    SYS_getresgid,
    SYS_getgroups,
    SYS_getpgid,
    SYS_getsid,
    SYS_capget,
    SYS_getrusage,
    SYS_times,
    SYS_getpriority,
    SYS_uname,
    SYS_sysinfo,
    SYS_getrandom,
    SYS_getcpu,
    SYS_personality,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_rt_sigpending,
    SYS_rt_sigsuspend,
    SYS_rt_sigtimedwait,
    SYS_sigaltstack,
    SYS_restart_syscall,
    // threads and time
    SYS_futex,
    SYS_set_tid_address,
    SYS_set_robust_list,
    SYS_get_robust_list,
    334 - 41 * (kMachine == AUDIT_ARCH_AARCH64) /* rseq */,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_sched_getparam,
    SYS_sched_getscheduler,
    SYS_sched_get_priority_max,
    SYS_sched_get_priority_min,
    SYS_nanosleep,
    SYS_clock_nanosleep,
    SYS_clock_gettime,
    SYS_clock_getres,
    SYS_gettimeofday,
    SYS_getitimer,
    SYS_setitimer,
#ifdef SYS_open  // names of older machines
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_getdents,
    SYS_dup2,
    SYS_pipe,
    SYS_poll,
    SYS_select,
    SYS_epoll_create,
    SYS_epoll_wait,
    SYS_eventfd,
    SYS_getpgrp,
    SYS_getrlimit,
    SYS_time,
    SYS_alarm,
    SYS_pause,
    SYS_arch_prctl,
#endif
};
/// Refused as if the kernel did not have them, so that the C library takes the older ones, whose arguments can be seen.
constexpr int kUnknown[] = {425 /* io_uring_setup */, 435 /* clone3 */, 437 /* openat2 */};

constexpr sock_filter load(std::size_t offset) { return {BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)}; }
constexpr sock_filter give(std::uint32_t result) { return {BPF_RET | BPF_K, 0, 0, result}; }
/// Skips one step where the value is not this one.
constexpr sock_filter skip_unless(std::uint32_t value) { return {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, value}; }
constexpr std::uint32_t kEperm = SECCOMP_RET_ERRNO | EPERM, kEnosys = SECCOMP_RET_ERRNO | ENOSYS;

/// A list of steps that fits the stack: between fork and exec no memory can be taken. Of arguments the low half of 64 bits is seen, as of
/// little-endian machines; those that decide are of 32 bits.
class Filter {
public:
    void add(sock_filter step) { steps_[count_++] = step; }
    void answer(int call, std::uint32_t result) { add(skip_unless(static_cast<std::uint32_t>(call))), add(give(result)); }
    /// Allows the call with one of these values of an argument.
    void allow_values(int call, std::size_t argument, std::initializer_list<std::uint32_t> values) {
        add({BPF_JMP | BPF_JEQ | BPF_K, 0, static_cast<std::uint8_t>(2 * values.size() + 2), static_cast<std::uint32_t>(call)});
        add(load(offsetof(seccomp_data, args) + 8 * argument));
        for (const std::uint32_t value : values) add(skip_unless(value)), add(give(SECCOMP_RET_ALLOW));
        add(give(kEperm));
    }
    /// Allows the call if all of the bits of an argument are as in `wanted`: all set, or none.
    void allow_bits(int call, std::size_t argument, std::uint32_t bits, bool wanted) {
        add({BPF_JMP | BPF_JEQ | BPF_K, 0, 4, static_cast<std::uint32_t>(call)});
        add(load(offsetof(seccomp_data, args) + 8 * argument));
        add({BPF_JMP | BPF_JSET | BPF_K, static_cast<std::uint8_t>(wanted ? 0 : 1), static_cast<std::uint8_t>(wanted ? 1 : 0), bits});
        add(give(SECCOMP_RET_ALLOW));
        add(give(kEperm));
    }
    void install() {
        const sock_fprog program{static_cast<unsigned short>(count_), steps_};
        (void)::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
    }

private:
    static constexpr std::size_t kOthers = 96;  // steps beside those of the lists
    sock_filter steps_[2 * (std::size(kAllowed) + std::size(kUnknown)) + kOthers];
    std::size_t count_ = 0;
};

void refuse_calls() {
    Filter filter;
    filter.add(load(offsetof(seccomp_data, arch)));
    filter.add({BPF_JMP | BPF_JEQ | BPF_K, 1, 0, kMachine});
    filter.add(give(SECCOMP_RET_KILL_PROCESS));
    filter.add(load(offsetof(seccomp_data, nr)));
    for (const int call : kAllowed) filter.answer(call, SECCOMP_RET_ALLOW);
    for (const int call : kUnknown) filter.answer(call, kEnosys);
    constexpr std::uint32_t kWrites = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
    filter.allow_bits(SYS_openat, 2, kWrites, false);
#ifdef SYS_open
    filter.allow_bits(SYS_open, 1, kWrites, false);
#endif
    filter.allow_bits(SYS_clone, 0, CLONE_THREAD, true);
    filter.allow_values(SYS_prlimit64, 0, {0});  // its own
    filter.allow_values(SYS_tgkill, 0, {static_cast<std::uint32_t>(::getpid())});
    constexpr std::uint32_t kSetMemoryName = 0x53564d41;
    filter.allow_values(SYS_prctl, 0, {PR_SET_NAME, PR_GET_NAME, PR_GET_DUMPABLE, PR_CAPBSET_READ, kSetMemoryName});
    filter.allow_values(SYS_fcntl, 1, {F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC});
    constexpr std::uint32_t kTerminal = 0x5401, kReadable = 0x541B, kClose = 0x5451;  // TCGETS, FIONREAD, FIOCLEX
    filter.allow_values(SYS_ioctl, 1, {kTerminal, kReadable, kClose});
    filter.add(give(kEperm));
    filter.install();
}
#else
void refuse_calls() {}
#endif

}  // namespace

Confinement::Confinement(const std::string& program) {
    const Rules first{kAllOfFirstVersion};
    const long version = ::syscall(kCreateRules, nullptr, 0, 1);
    if (version < 1) return;
    const Rules rules{first.files | (version >= 2 ? kRefer : 0) | (version >= 3 ? kTruncate : 0)};
    const int made = static_cast<int>(::syscall(kCreateRules, &rules, sizeof rules, 0));
    if (made < 0) return;
    rules_ = ::fcntl(made, F_DUPFD_CLOEXEC, kLowestOwn);
    (void)::close(made);
    if (rules_ < 0) return;
    for (const char* folder : {"/usr", "/bin", "/lib", "/lib64", "/nix/store", "/gnu/store"}) allow_reading(rules_, folder, true);
    for (const char* file : {"/etc/ld.so.cache", "/dev/null", "/dev/urandom"}) allow_reading(rules_, file, false);
    allow_reading(rules_, program.substr(0, program.rfind('/') + 1).c_str(), true);
}

Confinement::~Confinement() {
    if (rules_ >= 0) (void)::close(rules_);
}

void confine(const Confinement& confinement) {
    constexpr int kMostCapabilities = 64;
    for (int i = 0; i < kMostCapabilities; ++i) (void)::prctl(PR_CAPBSET_DROP, i, 0, 0, 0);  // of root
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
    if (confinement.rules() >= 0) (void)::syscall(kRestrict, confinement.rules(), 0);
    refuse_calls();
}

#else

Confinement::Confinement(const std::string& /*program*/) {}
Confinement::~Confinement() = default;
void confine(const Confinement& /*confinement*/) {}

#endif

void close_from(int first) {
#if defined(__linux__)
    constexpr long kCloseRange = 436;
    if (::syscall(kCloseRange, first, ~0U, 0) == 0) return;
#endif
    struct rlimit limit {};
    const int most = ::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < 65536 ? static_cast<int>(limit.rlim_cur) : 65536;
    for (int i = first; i < most; ++i) (void)::close(i);
}

}  // namespace halflit::platform
