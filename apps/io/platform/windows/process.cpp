#include "apps/io/platform/process.hpp"

#include "apps/io/platform/windows/wide.hpp"

#include <psapi.h>
#include <shellapi.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <memory>

namespace halflit::platform {
namespace {

void (*words_before_end)(int) = nullptr;

/// Runs on a thread that Windows starts. Windows ends the process some seconds after the terminal was closed, whatever happens here.
BOOL WINAPI end_by_control(DWORD control) {
    static std::atomic<bool> has_begun{false};
    if (has_begun.exchange(true)) Sleep(INFINITE);  // the first call ends the process
    const int signal = control == CTRL_C_EVENT || control == CTRL_BREAK_EVENT ? SIGINT : SIGTERM;
    words_before_end(signal);
    TerminateProcess(GetCurrentProcess(), static_cast<UINT>(128 + signal));
    return TRUE;
}

/// A text of the registry below HKEY_LOCAL_MACHINE; empty where it is not there.
std::string registry_text(const wchar_t* key, const wchar_t* name) {
    wchar_t text[256] = L"";
    DWORD bytes = sizeof text;
    if (RegGetValueW(HKEY_LOCAL_MACHINE, key, name, RRF_RT_REG_SZ, nullptr, text, &bytes) != ERROR_SUCCESS) return {};
    std::string made = narrow(text);
    made.erase(made.find_last_not_of(' ') + 1);
    return made;
}

}  // namespace

std::vector<std::string> arguments(int argc, char** argv) {
    int count = 0;
    const std::unique_ptr<wchar_t*, decltype(&LocalFree)> words(CommandLineToArgvW(GetCommandLineW(), &count), &LocalFree);
    std::vector<std::string> made;
    if (!words) return {argv + std::min(argc, 1), argv + argc};
    for (int i = 1; i < count; ++i) {
        std::string word = narrow(words.get()[i]);
        if (!word.starts_with("\\\\?\\")) std::replace(word.begin(), word.end(), '\\', '/');
        made.push_back(std::move(word));
    }
    return made;
}

std::int64_t process_id() { return GetCurrentProcessId(); }

bool may_be_running(std::int64_t process) {
    const HANDLE handle = OpenProcess(SYNCHRONIZE, FALSE, static_cast<DWORD>(process));
    if (handle == nullptr) return GetLastError() != ERROR_INVALID_PARAMETER;
    const bool runs = WaitForSingleObject(handle, 0) != WAIT_OBJECT_0;
    CloseHandle(handle);
    return runs;
}

std::size_t stack_limit() { return 0; }

std::int64_t peak_memory() {
    PROCESS_MEMORY_COUNTERS counters{};
    counters.cb = sizeof counters;
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) ? static_cast<std::int64_t>(counters.PeakWorkingSetSize)
                                                                                 : 0;
}

int limit_memory(std::size_t bytes) {
    // The job lives as long as the process, which is alone in it.
    const HANDLE job = CreateJobObjectW(nullptr, nullptr);
    if (job == nullptr) return set_errno();
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limit{};
    limit.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_PROCESS_MEMORY;
    limit.ProcessMemoryLimit = bytes;
    if (SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limit, sizeof limit) &&
        AssignProcessToJobObject(job, GetCurrentProcess()))
        return 0;
    const int error = set_errno();
    CloseHandle(job);
    return error;
}

void prepare_heap() {}

void give_back(std::byte*, std::size_t) {}

std::string system_name() {
    constexpr const wchar_t* kKey = L"SOFTWARE\\Microsoft\\Windows NT\\CurrentVersion";
    // The version that the kernel tells; GetVersionEx tells an older one to programs that do not name a newer one.
    using Version = LONG(WINAPI*)(OSVERSIONINFOW*);
    const HMODULE kernel = GetModuleHandleW(L"ntdll.dll");
    OSVERSIONINFOW version{};
    version.dwOSVersionInfoSize = sizeof version;
    std::string name = "Windows";
    if (const auto get = reinterpret_cast<Version>(reinterpret_cast<void (*)()>(GetProcAddress(kernel, "RtlGetVersion")));
        get != nullptr && get(&version) == 0)
        name = name + " " + std::to_string(version.dwMajorVersion) + "." + std::to_string(version.dwMinorVersion) + "." +
               std::to_string(version.dwBuildNumber);
    name += " x86_64";
    if (const std::string product = registry_text(kKey, L"ProductName"); !product.empty()) name += ", " + product;
    using WineVersion = const char*(CDECL*)();
    if (const auto get = reinterpret_cast<WineVersion>(reinterpret_cast<void (*)()>(GetProcAddress(kernel, "wine_get_version")));
        get != nullptr)
        name += std::string(", wine ") + get();
    return name;
}

std::string processor_name() { return registry_text(L"HARDWARE\\DESCRIPTION\\System\\CentralProcessor\\0", L"ProcessorNameString"); }

void call_before_end(void (*last_words)(int signal)) {
    words_before_end = last_words;
    SetConsoleCtrlHandler(end_by_control, TRUE);
}

void wait_for_end() {
    for (;;) Sleep(INFINITE);
}

}  // namespace halflit::platform
