// The folder that tools read models from: paths that lead out of it are refused.
#pragma once

#include "halflit/error.hpp"

#include <string>

namespace halflit::cli {

class ModelFolder {
public:
    /// Makes the folder the process's current one, so that names in reports are relative to it. Fails (io) if it is none.
    /// allow_external: files outside of it may be read.
    [[nodiscard]] static Result<ModelFolder> enter(const std::string& path, bool allow_external);

    /// The path of a file to be read, relative to the folder; absolute outside of it. Symbolic links are resolved first. Fails (io) for a
    /// path that leads out of the folder, and for one that is no file.
    [[nodiscard]] Result<std::string> to_read(const std::string& path) const;
    /// The path of a file to be written, always below the folder. Fails (io) for a path that leads out of it.
    [[nodiscard]] Result<std::string> to_write(const std::string& path) const;

private:
    [[nodiscard]] Result<std::string> resolved(const std::string& path) const;
    [[nodiscard]] bool holds(const std::string& path) const;
    [[nodiscard]] std::string shown(const std::string& path) const;

    std::string root_;  ///< absolute, without links, with '/' at its end
    bool allow_external_ = false;
};

}  // namespace halflit::cli
