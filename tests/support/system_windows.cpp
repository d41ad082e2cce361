#include "apps/io/platform/windows/wide.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <array>
#include <map>

namespace halflit::test {
namespace {

using platform::kShareAll, platform::wide;

/// The words as CommandLineToArgvW takes them apart again.
std::wstring command_line(const std::vector<std::string>& words) {
    std::wstring line;
    for (const std::string& word : words) {
        if (!line.empty()) line += L' ';
        line += L'"';
        std::size_t backslashes = 0;
        for (const wchar_t c : wide(word)) {
            if (c == L'"') line.append(backslashes + 1, L'\\');
            backslashes = c == L'\\' ? backslashes + 1 : 0;
            line += c;
        }
        line.append(backslashes, L'\\');
        line += L'"';
    }
    return line;
}

std::wstring environment_of(const RunSettings& settings) {
    std::map<std::wstring, std::wstring> values;
    wchar_t* const own = GetEnvironmentStringsW();
    for (const wchar_t* entry = own; *entry != L'\0'; entry += std::wstring_view(entry).size() + 1) {
        const std::wstring text = entry;
        if (const std::size_t equals = text.find(L'=', 1); equals != std::wstring::npos)
            values[text.substr(0, equals)] = text.substr(equals + 1);
    }
    FreeEnvironmentStringsW(own);
    values.erase(L"COLUMNS");
    values.erase(L"NO_COLOR");
    values[L"TERM"] = L"xterm";
    for (const auto& [name, value] : settings.environment) values[wide(name)] = wide(value);
    std::wstring block;
    for (const auto& [name, value] : values) {
        block += name + L"=" + value;
        block += L'\0';
    }
    block += L'\0';
    return block;
}

HANDLE start(const std::vector<std::string>& words, const RunSettings& settings, const std::array<HANDLE, 3>& streams) {
    STARTUPINFOW startup{};
    startup.cb = sizeof startup;
    startup.dwFlags = STARTF_USESTDHANDLES;
    startup.hStdInput = streams[0], startup.hStdOutput = streams[1], startup.hStdError = streams[2];
    std::wstring line = command_line(words), environment = environment_of(settings);
    const std::wstring folder = wide(settings.folder);
    PROCESS_INFORMATION process{};
    REQUIRE(CreateProcessW(wide(words[0]).c_str(), line.data(), nullptr, nullptr, TRUE, CREATE_UNICODE_ENVIRONMENT, environment.data(),
                           folder.empty() ? nullptr : folder.c_str(), &startup, &process));
    CloseHandle(process.hThread);
    return process.hProcess;
}

HANDLE inherited_file(const std::filesystem::path& path, bool is_input) {
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    const HANDLE file = CreateFileW(path.c_str(), is_input ? GENERIC_READ : GENERIC_WRITE, kShareAll, &inherited,
                                    is_input ? OPEN_EXISTING : CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
    REQUIRE(file != INVALID_HANDLE_VALUE);
    return file;
}

/// Both ends of a pipe; the child inherits one of them.
struct Pipe {
    HANDLE read = nullptr, write = nullptr;
    explicit Pipe(bool child_reads) {
        SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
        REQUIRE(CreatePipe(&read, &write, &inherited, 1 << 16));
        SetHandleInformation(child_reads ? write : read, HANDLE_FLAG_INHERIT, 0);
    }
};

int exit_code(HANDLE process) {
    DWORD code = 0;
    GetExitCodeProcess(process, &code);
    CloseHandle(process);
    return static_cast<int>(code);
}

}  // namespace

bool make_link(const std::filesystem::path& target, const std::filesystem::path& link) {
    const std::filesystem::path whole = target.is_absolute() ? target : link.parent_path() / target;
    const DWORD is_folder = std::filesystem::is_directory(whole) ? SYMBOLIC_LINK_FLAG_DIRECTORY : 0;
    constexpr DWORD kUnprivileged = 2;  // SYMBOLIC_LINK_FLAG_ALLOW_UNPRIVILEGED_CREATE
    // wine says that it has made one.
    return CreateSymbolicLinkW(link.c_str(), target.c_str(), is_folder | kUnprivileged) &&
           GetFileAttributesW(link.c_str()) != INVALID_FILE_ATTRIBUTES;
}

bool make_pipe(const std::filesystem::path& /*path*/) { return false; }

double processor_s_of_children() { return 0; }

Abilities abilities() {
    const bool is_wine = GetProcAddress(GetModuleHandleW(L"ntdll.dll"), "wine_get_version") != nullptr;
    return {false, false, false, !is_wine, false, !is_wine, false};  // wine knows jobs without limits
}

Outcome run_program(const std::vector<std::string>& words, const RunSettings& settings) {
    REQUIRE(!settings.terminal_columns);
    REQUIRE(!settings.largest_file);
    const TemporaryFolder folder;
    folder.write("in", settings.input);
    std::optional<Pipe> held;
    if (settings.hold_input_open) {
        held.emplace(true);
        DWORD written = 0;
        REQUIRE(WriteFile(held->write, settings.input.data(), static_cast<DWORD>(settings.input.size()), &written, nullptr));
    }
    std::array<HANDLE, 3> streams{held ? held->read : inherited_file(folder / "in", true), inherited_file(folder / "out", false),
                                  inherited_file(folder / "err", false)};
    std::array<HANDLE, 3> given = streams;
    if (settings.closed) given[static_cast<std::size_t>(*settings.closed)] = nullptr;
    const HANDLE process = start(words, settings, given);
    for (const HANDLE stream : streams) CloseHandle(stream);
    std::optional<int> sent;
    while (WaitForSingleObject(process, settings.signal && !sent ? 1 : INFINITE) == WAIT_TIMEOUT) {
        sent = settings.signal();
        if (!sent) continue;
        REQUIRE(*sent == kKill);
        TerminateProcess(process, 128 + kKill);
    }
    Outcome outcome;
    outcome.code = exit_code(process);
    if (held) CloseHandle(held->write);
    outcome.out = contents(folder / "out");
    outcome.err = contents(folder / "err");
    return outcome;
}

int run_shell(const std::string& /*line*/) { return -1; }

struct PipedProgram::State {
    HANDLE process = nullptr, input = nullptr, output = nullptr;
};

PipedProgram::PipedProgram(const std::vector<std::string>& words) : state_(std::make_unique<State>()) {
    const Pipe to_child(true), from_child(false);
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    const HANDLE nowhere = CreateFileW(L"NUL", GENERIC_WRITE, kShareAll, &inherited, OPEN_EXISTING, 0, nullptr);
    state_->process = start(words, {}, {to_child.read, from_child.write, nowhere});
    for (const HANDLE handle : {to_child.read, from_child.write, nowhere}) CloseHandle(handle);
    state_->input = to_child.write, state_->output = from_child.read;
}

PipedProgram::~PipedProgram() {
    if (state_->process != nullptr) (void)end();
    CloseHandle(state_->output);
}

void PipedProgram::write(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
        DWORD done = 0;
        REQUIRE(WriteFile(state_->input, text.data() + sent, static_cast<DWORD>(text.size() - sent), &done, nullptr));
        sent += done;
    }
}

std::string PipedProgram::read() const {
    constexpr int kPatienceMs = 120'000;
    DWORD bytes = 0;
    for (int waited = 0; bytes == 0 && waited < kPatienceMs; ++waited) {
        REQUIRE(PeekNamedPipe(state_->output, nullptr, 0, nullptr, &bytes, nullptr));
        if (bytes == 0) Sleep(1);
    }
    REQUIRE(bytes > 0);
    std::string part(bytes, '\0');
    REQUIRE(ReadFile(state_->output, part.data(), bytes, &bytes, nullptr));
    part.resize(bytes);
    return part;
}

int PipedProgram::end() {
    CloseHandle(state_->input);
    WaitForSingleObject(state_->process, INFINITE);
    return exit_code(std::exchange(state_->process, nullptr));
}

}  // namespace halflit::test
