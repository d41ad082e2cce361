// The pictures that materials use: fetched, decoded under limits, made into textures. One texture for each picture, colour space and rule
// of its levels.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/texture.hpp"

#include <atomic>
#include <cstddef>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace halflit::io::detail {

class ImageStore {
public:
    ImageStore(Document& document, std::vector<Texture>& textures);
    /// Waits for pictures that are being decoded, and leaves out the others.
    ~ImageStore();

    /// Index into the scene's textures for an entry of "images", which is decoded later. Throws LoadFailure, or, when lenient, warns and
    /// chooses a magenta checkerboard.
    int texture_for(int image, ColorSpace space, MipRule rule = MipRule::equal);

    /// Begins to decode all pictures on other threads, if they are large. Until finish(), the scene's textures are not to be read, and
    /// there must be no further call of texture_for.
    void start();
    /// Decodes the pictures that no thread has begun, and waits. Fails as texture_for, for the first picture that cannot be decoded. (One
    /// that cannot be read, or whose header is wrong, has failed in texture_for.)
    void finish();

private:
    /// A picture to be decoded.
    struct Job {
        int texture;  ///< index into textures_
        ColorSpace space;
        MipRule rule;
        std::string where;
        std::vector<std::byte> owned;  ///< a file's content; empty if `bytes` lie in a buffer
        std::span<const std::byte> bytes;
        int width, height;
        bool keep_16_bits;
        std::exception_ptr failure;
    };

    [[nodiscard]] Job prepare(int image, ColorSpace space, MipRule rule, int texture);
    [[nodiscard]] Texture make(const Job& job) const;
    void run(Job& job);
    [[nodiscard]] std::size_t other_threads() const;
    void run_jobs();
    /// For a failure that lenient loading draws as a checkerboard; else throws it again.
    void replace(int texture, ColorSpace space, const LoadFailure& failure);

    Document& document_;
    std::vector<Texture>& textures_;
    Budget texture_memory_;
    std::vector<Job> jobs_;
    std::map<std::tuple<std::string, ColorSpace, MipRule>, int> made_;  // indexed by the picture's source
    std::atomic<std::size_t> next_job_ = 0;
    std::vector<std::jthread> threads_;  // last, so that they end before what they use
};

}  // namespace halflit::io::detail
