// Reading of whole files into memory, with a limit. A model's own references are confined to the model's folder.
#pragma once

#include "apps/io/files/text.hpp"
#include "apps/io/platform/handles.hpp"
#include "halflit/error.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io {

inline constexpr std::size_t kDefaultMaxFileBytes = std::size_t{512} << 20;

/// Reads a regular file that the user named. Errors: io if it cannot be opened or read, limit above `max_bytes`, bad_input if its size
/// changed while it was read. The file is not mapped, so one that shrinks cannot raise SIGBUS.
Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes = kDefaultMaxFileBytes);

/// A file's bytes that this thread owns, while a reader takes them once, from the first to the last: the memory of those that it has taken
/// is given back, so that file and model are not there at once. Readers of bytes that a caller owns give nothing back.
class [[nodiscard]] TakenBytes {
public:
    explicit TakenBytes(std::span<std::byte> bytes);
    ~TakenBytes();
    TakenBytes(const TakenBytes&) = delete;
    TakenBytes& operator=(const TakenBytes&) = delete;

    /// Nothing between the place of the first call and `at` is read any more.
    static void before(const void* at);

private:
    std::span<std::byte> bytes_;
    std::size_t given_back_ = 0;  ///< up to there; 0: nothing yet
    TakenBytes* outer_;
};

/// Opens files by the names that a model gives, below the model's folder or one that is allowed: no absolute name, no ".." and no symbolic
/// link that leads elsewhere, and regular files alone (a FIFO or a device is refused without waiting for it). On Windows no links at all,
/// and no name that Windows takes for a device, a stream or a drive.
class ModelFolder {
public:
    /// `base_dir` is the model's folder; empty means that there is none. `also_allowed` are folders in which a name is looked up when the
    /// model's folder does not have it, and into which a name may lead.
    explicit ModelFolder(std::string base_dir = "", std::vector<std::string> also_allowed = {});
    ~ModelFolder();
    ModelFolder(const ModelFolder&) = delete;
    ModelFolder& operator=(const ModelFolder&) = delete;

    /// An error (usage) that names the first folder of `also_allowed` which cannot be opened.
    [[nodiscard]] Result<void> check() const;

    /// `relative` uses '/' and has been percent-decoded. Errors: bad_input where there is no such file or it may not be read from here,
    /// limit above `max_bytes` or without memory, io for every other fault of the file system; the message has no file prefix.
    [[nodiscard]] Result<std::vector<std::byte>> read(std::string_view relative, std::size_t max_bytes);
    /// The same for a name as programs write it: '\\' between folders, "?query" at its end, letters in another case than one file has, or a
    /// folder of another computer, where a file of that name lies beside the model or in its folder textures. found: the name that was
    /// read.
    [[nodiscard]] Result<std::vector<std::byte>> read_like(std::string_view name, std::size_t max_bytes, std::string& found);
    /// Paths at which such a name may mean a file, whether it is there or not.
    [[nodiscard]] std::vector<std::string> places(std::string_view relative) const;

private:
    struct Folder {
        platform::NativeHandle handle;
        int error;         ///< errno where it could not be opened, or 0
        std::string name;  ///< as it was given, made absolute, without "." and ".."
        std::string at;    ///< its place, without symbolic links; empty where it is not known
    };
    void add(const std::string& path);

    std::vector<Folder> folders_;  ///< the model's folder first, if there is one
    bool has_base_ = false;
    std::string missing_;  ///< message of check()
};

}  // namespace halflit::io
