/* Lets a shared library that is linked with glibc load under musl. musl's loader takes libc.so.6 and its parts for itself, and ignores
   versions of symbols. This file has the names that musl lacks, a strerror_r with glibc's result, and larger stacks for threads.
   musl_names.txt lists what the library may take from musl. One difference has no name: the C++ library's locales read tables from a
   locale_t, where musl has none, so nothing that reads text by streams may be linked (build_wheel.py looks). */
#define _GNU_SOURCE
#include <errno.h>
#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <sys/auxv.h>
#include <time.h>
#if defined __x86_64__
#define OLDEST "GLIBC_2.2.5"
#elif defined __aarch64__
#define OLDEST "GLIBC_2.17"
#endif

unsigned long __getauxval(unsigned long type);
unsigned long __getauxval(unsigned long type) { return getauxval(type); }

int __pthread_key_create(pthread_key_t* key, void (*end)(void*));
int __pthread_key_create(pthread_key_t* key, void (*end)(void*)) { return pthread_key_create(key, end); }

size_t __strftime_l(char* text, size_t size, const char* format, const struct tm* time, locale_t locale);
size_t __strftime_l(char* text, size_t size, const char* format, const struct tm* time, locale_t locale) {
    return strftime_l(text, size, format, time, locale);
}

/* glibc's own returns the text, POSIX's and musl's a number. */
int __xpg_strerror_r(int code, char* text, size_t size);
char* strerror_r(int code, char* text, size_t size) {
    if (__xpg_strerror_r(code, text, size) == EINVAL) snprintf(text, size, "Unknown error %d", code);
    return text;
}

/* musl's threads have stacks of 128 KiB unless a size is asked for. What is less than 1 MiB becomes 8 MiB, glibc's usual size: with glibc
   too, where a limit of the process asks for less. Functions of the caller run on these stacks, as Python's progress. */
int system_pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument);
__asm__(".symver system_pthread_create, pthread_create@" OLDEST);

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    const size_t least = 1 << 20, usual = 8 << 20;
    pthread_attr_t own;
    size_t size = 0;
    int code;
    if (attributes != NULL || pthread_attr_init(&own) != 0) return system_pthread_create(thread, attributes, run, argument);
    if (pthread_attr_getstacksize(&own, &size) == 0 && size < least) (void)pthread_attr_setstacksize(&own, usual);
    code = system_pthread_create(thread, &own, run, argument);
    (void)pthread_attr_destroy(&own);
    return code;
}
