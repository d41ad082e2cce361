/* What the compiler's libraries (libstdc++, libgcc_eh) take from a glibc that is newer than the one that portable programs are linked with.
   Each stands in for a function or variable of glibc's documentation. They are not visible outside of the program or library. */
#define _GNU_SOURCE
#include <link.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

/* glibc 2.32: not 0 as long as there is one thread alone. 0 is always right: counters are then changed by atomic operations. */
char __libc_single_threaded = 0;

/* glibc 2.36: a random number. getentropy is the kernel's; it fails on Linux before 3.17 alone. */
uint32_t arc4random(void);
uint32_t arc4random(void) {
    uint32_t value;
    if (getentropy(&value, sizeof value) != 0) abort();
    return value;
}

/* glibc 2.35: the object (program or library) that holds an address, for the unwinding of exceptions. */
struct dl_find_object {
    unsigned long long flags;
    void* map_start;
    void* map_end;
    struct link_map* link_map;
    void* eh_frame; /* the segment PT_GNU_EH_FRAME */
    unsigned long long reserved[7];
};

struct search {
    ElfW(Addr) address;
    struct dl_find_object* result;
};

static int look_into(struct dl_phdr_info* object, size_t size, void* data) {
    const struct search* const search = data;
    ElfW(Addr) first = UINTPTR_MAX;
    ElfW(Addr) end = 0;
    ElfW(Addr) eh_frame = 0;
    int holds = 0;
    (void)size;
    for (int i = 0; i < object->dlpi_phnum; ++i) {
        const ElfW(Phdr)* const part = &object->dlpi_phdr[i];
        const ElfW(Addr) start = object->dlpi_addr + part->p_vaddr;
        if (part->p_type == PT_GNU_EH_FRAME) eh_frame = start;
        if (part->p_type != PT_LOAD) continue;
        if (start < first) first = start;
        if (start + part->p_memsz > end) end = start + part->p_memsz;
        if (search->address >= start && search->address - start < part->p_memsz) holds = 1;
    }
    if (!holds || eh_frame == 0) return 0;
    *search->result = (struct dl_find_object){0, (void*)first, (void*)end, NULL, (void*)eh_frame, {0}};
    return 1;
}

/* 0 where an object was found. */
int _dl_find_object(void* address, struct dl_find_object* result);
int _dl_find_object(void* address, struct dl_find_object* result) {
    struct search search = {(ElfW(Addr))address, result};
    return dl_iterate_phdr(look_into, &search) == 1 ? 0 : -1;
}
