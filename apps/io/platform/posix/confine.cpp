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

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;  // no filter
#endif

/// System calls that no reader of a model needs: they change files, reach other processes or machines, or widen rights.
constexpr int kRefused[] = {
    SYS_socket,
    SYS_socketpair,
    SYS_connect,
    SYS_bind,
    SYS_sendto,
    SYS_sendmsg,
    SYS_ptrace,
    SYS_process_vm_readv,
    SYS_process_vm_writev,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_setns,
    SYS_unshare,
    SYS_keyctl,
    SYS_add_key,
    SYS_request_key,
    SYS_bpf,
    SYS_perf_event_open,
    SYS_unlinkat,
    SYS_renameat,
    SYS_renameat2,
    SYS_linkat,
    SYS_symlinkat,
    SYS_mkdirat,
    SYS_mknodat,
    SYS_fchmod,
    SYS_fchmodat,
    SYS_fchown,
    SYS_fchownat,
    SYS_truncate,
    SYS_setxattr,
    SYS_fsetxattr,
    SYS_utimensat,
    SYS_kill,
    SYS_tkill,
    SYS_init_module,
    SYS_finit_module,
    SYS_kexec_load,
    SYS_reboot,
    SYS_swapon,
    SYS_userfaultfd,
    SYS_setpgid,
    SYS_setsid,
    SYS_msgget,
    SYS_shmget,
    SYS_mq_open,
#ifdef SYS_open  // names of older machines
    SYS_creat,
    SYS_fork,
    SYS_vfork,
    SYS_unlink,
    SYS_rename,
    SYS_link,
    SYS_symlink,
    SYS_mkdir,
    SYS_rmdir,
    SYS_mknod,
    SYS_chmod,
    SYS_chown,
    SYS_lchown,
    SYS_utime,
    SYS_utimes,
    SYS_setrlimit,
#endif
};
/// Refused as if the kernel did not have them, so that the C library takes the older ones, whose arguments can be seen.
constexpr int kUnknown[] = {425 /* io_uring_setup */, 435 /* clone3 */, 437 /* openat2 */};

constexpr sock_filter load(std::size_t offset) { return {BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)}; }
constexpr sock_filter give(std::uint32_t result) { return {BPF_RET | BPF_K, 0, 0, result}; }
/// Skips one step where the value is this one.
constexpr sock_filter skip_unless(std::uint32_t value) { return {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, value}; }
constexpr std::uint32_t kEperm = SECCOMP_RET_ERRNO | EPERM, kEnosys = SECCOMP_RET_ERRNO | ENOSYS;

/// A list of steps that fits the stack: between fork and exec no memory can be taken.
class Filter {
public:
    void add(sock_filter step) { steps_[count_++] = step; }
    void refuse(int call, std::uint32_t result) { add(skip_unless(static_cast<std::uint32_t>(call))), add(give(result)); }
    /// Refuses the call if any (all = false) or not all (all = true) bits of an argument are set.
    void refuse_bits(int call, std::size_t argument, std::uint32_t bits, bool unless_set) {
        // the low half of 64 bits: little-endian machines alone have a filter
        add({BPF_JMP | BPF_JEQ | BPF_K, 0, 4, static_cast<std::uint32_t>(call)});
        add(load(offsetof(seccomp_data, args) + 8 * argument));
        const auto jump = [&](std::uint8_t set, std::uint8_t clear) { add({BPF_JMP | BPF_JSET | BPF_K, set, clear, bits}); };
        unless_set ? jump(1, 0) : jump(0, 1);
        add(give(kEperm));
        add(load(offsetof(seccomp_data, nr)));
    }
    void install() {
        const sock_fprog program{static_cast<unsigned short>(count_), steps_};
        (void)::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
    }

private:
    sock_filter steps_[256];
    std::size_t count_ = 0;
};

void refuse_calls() {
    if (kMachine == 0) return;
    Filter filter;
    filter.add(load(offsetof(seccomp_data, arch)));
    filter.add({BPF_JMP | BPF_JEQ | BPF_K, 1, 0, kMachine});
    filter.add(give(SECCOMP_RET_KILL_PROCESS));
    filter.add(load(offsetof(seccomp_data, nr)));
#ifdef __x86_64__
    constexpr std::uint32_t kX32 = 0x40000000;
    filter.add({BPF_JMP | BPF_JGE | BPF_K, 0, 1, kX32});
    filter.add(give(kEperm));
#endif
    for (const int call : kRefused) filter.refuse(call, kEperm);
    for (const int call : kUnknown) filter.refuse(call, kEnosys);
    constexpr std::uint32_t kWrites = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
    filter.refuse_bits(SYS_openat, 2, kWrites, false);
#ifdef SYS_open
    filter.refuse_bits(SYS_open, 1, kWrites, false);
#endif
    filter.refuse_bits(SYS_prlimit64, 2, ~0U, false);  // a new limit
    filter.refuse_bits(SYS_clone, 0, CLONE_THREAD, true);
    filter.add(give(SECCOMP_RET_ALLOW));
    filter.install();
}

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
    for (const char* folder : {"/usr", "/lib", "/lib64", "/nix/store", "/gnu/store"}) allow_reading(rules_, folder, true);
    for (const char* file : {"/etc/ld.so.cache", "/dev/null", "/dev/urandom"}) allow_reading(rules_, file, false);
    allow_reading(rules_, program.substr(0, program.rfind('/') + 1).c_str(), true);
}

Confinement::~Confinement() {
    if (rules_ >= 0) (void)::close(rules_);
}

void confine(const Confinement& confinement) {
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
