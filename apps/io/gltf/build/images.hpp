// The pictures that materials use: fetched, decoded under limits, made into textures. One texture for each picture, colour space and rule
// of its levels.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/material.hpp"
#include "halflit/texture.hpp"

#include <atomic>
#include <cstddef>
#include <exception>
#include <map>
#include <set>
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

    /// Index into the scene's textures for an entry of "images", which is decoded later. One that cannot be read is left out by
    /// finish(), with a warning; throws LoadFailure for what a limit refuses, and, if strict, for all.
    int texture_for(int image, ColorSpace space, MipRule rule = MipRule::equal);

    /// Begins to decode all pictures on other threads, if they are large. Until finish(), the scene's textures are not to be read, and
    /// there must be no further call of texture_for.
    void start();
    /// Decodes the pictures that no thread has begun, and waits. Takes those that cannot be read out of the materials. Fails as
    /// texture_for, for the first picture that cannot be decoded. (One that cannot be read, or whose header is wrong, has failed in
    /// texture_for.)
    void finish(std::vector<Material>& materials);

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
        int skip_levels;  ///< largest levels of the texture that are left out
        bool keep_16_bits;
        std::string damage;  ///< why not all of the picture could be read; empty: it was
        std::exception_ptr failure;
    };

    [[nodiscard]] Job prepare(int image, ColorSpace space, MipRule rule, int texture);
    [[nodiscard]] Texture make(Job& job) const;
    void run(Job& job);
    /// Makes the textures smaller than their pictures where all of them would take more than their limit.
    void fit_memory();
    [[nodiscard]] std::size_t other_threads() const;
    void run_jobs();
    /// Notes a texture without its picture, or throws the failure again.
    void lose(int texture, const LoadFailure& failure);

    Document& document_;
    std::vector<Texture>& textures_;
    std::uint64_t texture_bytes_ = 0, pixels_ = 0;  ///< of all pictures at their full size
    std::vector<Job> jobs_;
    std::set<int> lost_;                                                // textures without their pictures
    std::map<std::tuple<std::string, ColorSpace, MipRule>, int> made_;  // indexed by the picture's source
    std::atomic<std::size_t> next_job_ = 0;
    std::vector<std::jthread> threads_;  // last, so that they end before what they use
};

}  // namespace halflit::io::detail
