#include "apps/io/platform/streams.hpp"

#include "apps/io/platform/windows/wide.hpp"

#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace halflit::platform {
namespace {

HANDLE handle_of(Stream stream) {
    return GetStdHandle(stream == Stream::input ? STD_INPUT_HANDLE : stream == Stream::output ? STD_OUTPUT_HANDLE : STD_ERROR_HANDLE);
}

UINT code_page_before = 0;

void put_code_page_back() { SetConsoleOutputCP(code_page_before); }

}  // namespace

void prepare_streams() {
    for (const int fd : {0, 1, 2})
        if (_get_osfhandle(fd) == -1 || _get_osfhandle(fd) == -2) {
            // Opened for the opposite direction, so that reading from or writing to the closed stream stays an error.
            const int other = _open("NUL", fd == 0 ? _O_WRONLY : _O_RDONLY);
            if (other >= 0 && other != fd) {
                _dup2(other, fd);
                _close(other);
            }
        }
    for (std::FILE* const file : {stdin, stdout, stderr}) _setmode(_fileno(file), _O_BINARY);
    std::setvbuf(stderr, nullptr, _IONBF, 0);
    bool on_terminal = false;
    for (const Stream stream : {Stream::output, Stream::error}) {
        DWORD mode = 0;
        if (!GetConsoleMode(handle_of(stream), &mode)) continue;
        SetConsoleMode(handle_of(stream), mode | ENABLE_PROCESSED_OUTPUT | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
        on_terminal = true;
    }
    if (!on_terminal) return;
    code_page_before = GetConsoleOutputCP();
    if (code_page_before != 0 && code_page_before != CP_UTF8 && SetConsoleOutputCP(CP_UTF8)) std::atexit(put_code_page_back);
}

bool is_terminal(Stream stream) {
    DWORD mode = 0;
    return GetConsoleMode(handle_of(stream), &mode) != 0;
}

long terminal_columns() {
    CONSOLE_SCREEN_BUFFER_INFO info{};
    if (!GetConsoleScreenBufferInfo(handle_of(Stream::output), &info)) return 0;
    return info.srWindow.Right - info.srWindow.Left + 1;
}

bool wait_for_input(double ms) {
    const HANDLE input = handle_of(Stream::input);
    if (ms < 0 || GetFileType(input) != FILE_TYPE_PIPE) return true;  // a file's bytes are there; without a limit the read itself waits
    // A pipe is no object that can be waited for.
    constexpr DWORD kBetweenMs = 5;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double, std::milli>(std::min(ms, 1e9));
    for (;;) {
        DWORD bytes = 0;
        if (!PeekNamedPipe(input, nullptr, 0, nullptr, &bytes, nullptr) || bytes > 0)
            return true;  // its end, or an error, is read's to tell
        if (std::chrono::steady_clock::now() >= end) return false;
        Sleep(kBetweenMs);
    }
}

}  // namespace halflit::platform
