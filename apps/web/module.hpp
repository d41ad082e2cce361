// Shared by the sources whose functions JavaScript calls: *module.cpp.
// A scene is a handle. Texts are UTF-8 and end with a zero byte; what is returned lives until the next call for that scene.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/web/dropped_files.hpp"
#include "apps/web/picture_session.hpp"

#include <emscripten.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace halflit::web {

struct Handle {
    FileStore files;
    PictureSession session;
    std::string scene, text;  ///< text: an error's words, or JSON
};

/// 0, or the error's exit code, with its words in `text`.
template <class Work>
int attempt(std::string& text, const Work& work) {
    Result<void> done;
    try {
        done = work();
    } catch (const std::bad_alloc&) {
        done = fail(ErrorCode::limit, "out of memory");
    } catch (const std::length_error&) {  // a list of more than 2 GB
        done = fail(ErrorCode::limit, "out of memory");
    }
    if (done) return 0;
    text = done.error().message;
    return std::max(1, static_cast<int>(done.error().code));
}

/// An attempt with the scene's files.
template <class Work>
int attempt_on(Handle& handle, const Work& work) {
    use_files(&handle.files);
    handle.files.wanted.clear();
    return attempt(handle.text, work);
}

/// Flags of a call: one word a line.
[[nodiscard]] inline std::vector<std::string> lines_of(const std::string& text) { return engine::words_of(text, '\n'); }

}  // namespace halflit::web
