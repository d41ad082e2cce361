// The random number that salts the hash tables of expat, so that a stranger's file cannot choose names that collide. The host's generator
// gives it. Hosts without one (Node.js 18) have Math.random, which the engine seeds anew in each process.
#include <emscripten.h>

#include <cstddef>

EM_JS(void, halflit_random_bytes, (void* memory, std::size_t size), {
    const bytes = HEAPU8.subarray(memory, memory + size);
    if (globalThis.crypto && globalThis.crypto.getRandomValues) {
        globalThis.crypto.getRandomValues(bytes);
    } else {
        for (let i = 0; i < bytes.length; ++i) bytes[i] = 256 * Math.random();
    }
});

extern "C" void arc4random_buf(void* memory, std::size_t size) { halflit_random_bytes(memory, size); }
