// A library for LD_PRELOAD that makes one call of a program fail. Environment variables:
//   HALFLIT_FAULT_KIND    kind of call: alloc open read write fsync rename close stat thread mmap
//   HALFLIT_FAULT_AT      number of the call that fails, from 1; 0: none, calls are counted
//   HALFLIT_FAULT_ERROR   errno of the failure as a number; 0: the call succeeds in part (read and write: half of the bytes)
//   HALFLIT_FAULT_ON      1: all later calls fail too
//   HALFLIT_FAULT_LOG     file that gets, at the failure, the number of the call and the file opened last, and at the end the count
//   HALFLIT_FAULT_TRAP    1: SIGTRAP at the call, for a debugger
// Calls are counted from main() on: what the loader and the standard library do before it cannot be caught by any program.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

// glibc's own names of its allocator: dlsym allocates, so it cannot be used to find them.
extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* old, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);

enum Kind { kAlloc, kOpen, kRead, kWrite, kFsync, kRename, kClose, kStat, kThread, kMmap, kKinds };
static const char* const kNames[kKinds] = {"alloc", "open", "read", "write", "fsync", "rename", "close", "stat", "thread", "mmap"};

static int armed;           // set in main(), before threads exist
static int kind = -1;       // of the call that fails
static long at;             // its number, from 1
static int error_number;    // its errno; 0: partial success
static int from_there_on;   // later calls fail too
static int trap;            // a debugger waits
static int log_file = -1;   // descriptor
static atomic_long counts;  // calls of this kind
static char last_opened[512];

static void log_text(const char* text) {
    if (log_file >= 0 && syscall(SYS_write, log_file, text, strlen(text)) < 0) armed = 0;
}

static void log_number(const char* name, long number) {
    char text[64];
    char* end = text + sizeof text;
    *--end = '\0';
    *--end = '\n';
    do *--end = (char)('0' + number % 10);
    while ((number /= 10) > 0);
    log_text(name);
    log_text(end);
}

/// True if this call has to fail.
static int fails(enum Kind called) {
    if (!armed || (int)called != kind) return 0;
    const long number = atomic_fetch_add(&counts, 1) + 1;
    if (at == 0 || number < at || (number > at && !from_there_on)) return 0;
    if (number == at) {
        log_number("failed ", number);
        log_text("after ");
        log_text(last_opened);
        log_text("\n");
        if (trap) raise(SIGTRAP);
    }
    errno = error_number;
    return 1;
}

/// The system's function behind `name`.
static void* next(const char* name) {
    void* const found = dlsym(RTLD_NEXT, name);
    if (found == NULL) abort();
    return found;
}
#define NEXT(name)                                  \
    static __typeof__(&name) real;                  \
    if (real == NULL) *(void**)&real = next(#name); \
    (void)0

// ---- memory ------------------------------------------------------------------------------------------------------------
void* malloc(size_t size) { return fails(kAlloc) ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return fails(kAlloc) ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return fails(kAlloc) ? NULL : __libc_realloc(old, size); }
void* memalign(size_t alignment, size_t size) { return fails(kAlloc) ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return fails(kAlloc) ? NULL : __libc_memalign(alignment, size); }
int posix_memalign(void** out, size_t alignment, size_t size) {
    void* const made = fails(kAlloc) ? NULL : __libc_memalign(alignment, size);
    if (made == NULL) return ENOMEM;
    *out = made;
    return 0;
}

void* mmap(void* address, size_t length, int protection, int flags, int fd, off_t offset) {
    if (fails(kMmap)) return MAP_FAILED;
    return (void*)syscall(SYS_mmap, address, length, protection, flags, fd, offset);
}

// ---- files -------------------------------------------------------------------------------------------------------------
static void note_opened(const char* path) {
    if (armed && path != NULL) strncpy(last_opened, path, sizeof last_opened - 1);
}

static int open_at(int folder, const char* path, int flags, mode_t mode) {
    note_opened(path);
    if (fails(kOpen)) return -1;
    return (int)syscall(SYS_openat, folder, path, flags, mode);
}

#define MODE_ARGUMENT(flags)                                          \
    mode_t mode = 0;                                                  \
    if (((flags)&O_CREAT) != 0 || ((flags)&O_TMPFILE) == O_TMPFILE) { \
        va_list rest;                                                 \
        va_start(rest, flags);                                        \
        mode = va_arg(rest, mode_t);                                  \
        va_end(rest);                                                 \
    }                                                                 \
    (void)0

int open(const char* path, int flags, ...) {
    MODE_ARGUMENT(flags);
    return open_at(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    MODE_ARGUMENT(flags);
    return open_at(AT_FDCWD, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
    MODE_ARGUMENT(flags);
    return open_at(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
    MODE_ARGUMENT(flags);
    return open_at(folder, path, flags, mode);
}

/// openat2 has no function of its own.
long syscall(long number, ...) {
    static long (*real)(long, ...);
    if (real == NULL) *(void**)&real = next("syscall");
    long a[6];
    va_list rest;
    va_start(rest, number);
    for (int i = 0; i < 6; ++i) a[i] = va_arg(rest, long);
    va_end(rest);
    if (number == SYS_openat2) {
        note_opened((const char*)a[1]);
        if (fails(kOpen)) return -1;
    }
    return real(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

ssize_t read(int fd, void* to, size_t size) {
    NEXT(read);
    if (fails(kRead)) {
        if (error_number != 0) return -1;
        size = size > 1 ? size / 2 : size;
    }
    return real(fd, to, size);
}

ssize_t write(int fd, const void* from, size_t size) {
    NEXT(write);
    if (fails(kWrite)) {
        if (error_number != 0) return -1;
        size = size > 1 ? size / 2 : size;
    }
    return real(fd, from, size);
}

int fsync(int fd) {
    NEXT(fsync);
    return fails(kFsync) ? -1 : real(fd);
}

int fdatasync(int fd) {
    NEXT(fdatasync);
    return fails(kFsync) ? -1 : real(fd);
}

/// The descriptor is closed even where the call fails, as on Linux.
int close(int fd) {
    NEXT(close);
    const int failed = fails(kClose), result = real(fd);
    if (!failed) return result;
    errno = error_number;
    return -1;
}

int rename(const char* from, const char* to) {
    NEXT(rename);
    return fails(kRename) ? -1 : real(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
    NEXT(renameat);
    return fails(kRename) ? -1 : real(from_folder, from, to_folder, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
    NEXT(renameat2);
    return fails(kRename) ? -1 : real(from_folder, from, to_folder, to, flags);
}

int link(const char* from, const char* to) {
    NEXT(link);
    return fails(kRename) ? -1 : real(from, to);
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
    NEXT(linkat);
    return fails(kRename) ? -1 : real(from_folder, from, to_folder, to, flags);
}

int stat(const char* path, struct stat* info) {
    NEXT(stat);
    return fails(kStat) ? -1 : real(path, info);
}

int lstat(const char* path, struct stat* info) {
    NEXT(lstat);
    return fails(kStat) ? -1 : real(path, info);
}

int fstat(int fd, struct stat* info) {
    NEXT(fstat);
    return fails(kStat) ? -1 : real(fd, info);
}

int access(const char* path, int mode) {
    NEXT(access);
    return fails(kStat) ? -1 : real(path, mode);
}

int fchmod(int fd, mode_t mode) {
    NEXT(fchmod);
    return fails(kStat) ? -1 : real(fd, mode);
}

char* realpath(const char* path, char* resolved) {
    NEXT(realpath);
    return fails(kStat) ? NULL : real(path, resolved);
}

// ---- threads -----------------------------------------------------------------------------------------------------------
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    NEXT(pthread_create);
    return fails(kThread) ? error_number : real(thread, attributes, run, argument);
}

// ---- begin and end -----------------------------------------------------------------------------------------------------
static long number_of(const char* name) {
    const char* const text = getenv(name);
    return text == NULL ? 0 : strtol(text, NULL, 10);
}

static int (*real_main)(int, char**, char**);

static int armed_main(int argc, char** argv, char** environment) {
    const char* const wanted = getenv("HALFLIT_FAULT_KIND");
    for (int i = 0; i < kKinds && wanted != NULL; ++i)
        if (strcmp(wanted, kNames[i]) == 0) kind = i;
    at = number_of("HALFLIT_FAULT_AT");
    error_number = (int)number_of("HALFLIT_FAULT_ERROR");
    from_there_on = number_of("HALFLIT_FAULT_ON") != 0;
    trap = number_of("HALFLIT_FAULT_TRAP") != 0;
    const char* const log = getenv("HALFLIT_FAULT_LOG");
    if (log != NULL) log_file = (int)syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    armed = 1;
    return real_main(argc, argv, environment);
}

/// glibc calls main() from here.
int __libc_start_main(int (*main_function)(int, char**, char**), int argc, char** argv, void (*init)(void), void (*fini)(void),
                      void (*loader_fini)(void), void* stack_end) {
    int (*real)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*);
    *(void**)&real = next("__libc_start_main");
    real_main = main_function;
    return real(armed_main, argc, argv, init, fini, loader_fini, stack_end);
}

__attribute__((destructor)) static void log_count(void) {
    armed = 0;
    log_number("calls ", atomic_load(&counts));
}
