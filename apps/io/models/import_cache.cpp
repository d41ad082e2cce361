#include "apps/io/models/import_cache.hpp"

#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>
#include <tuple>

namespace halflit::io::detail {
namespace {

constexpr std::size_t kKeyBytes = 16, kSealBytes = 32, kMostKept = std::size_t{256} << 20, kMostOfOne = kMostKept / 4;

/// SipHash-2-4 of 128 bits [AB12]: somebody who does not know the key cannot make two files of one hash.
class SipHash {
public:
    explicit SipHash(std::span<const std::byte> key) {
        const std::uint64_t k0 = u64_at(key, 0), k1 = u64_at(key, 8);
        v_ = {k0 ^ 0x736f6d6570736575, k1 ^ 0x646f72616e646f6d ^ 0xee, k0 ^ 0x6c7967656e657261, k1 ^ 0x7465646279746573};
    }
    /// Each part counts with its length, so that no two lists of parts are one.
    void add(std::span<const std::byte> part) {
        std::size_t i = 0;
        for (; i + 8 <= part.size(); i += 8) add_word(u64_at(part, i));
        std::uint64_t last = std::uint64_t{part.size()} << 56;
        for (std::size_t k = 0; i < part.size(); ++i, k += 8) last |= std::uint64_t{byte_at(part, i)} << k;
        add_word(last);
        add_word(part.size());
    }
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
    [[nodiscard]] std::string hex() {
        const auto finish = [this] {
            for (int i = 0; i < 4; ++i) round();
            return (v_[0] ^ v_[1]) ^ (v_[2] ^ v_[3]);
        };
        v_[2] ^= 0xee;
        const std::uint64_t first = finish();
        v_[1] ^= 0xdd;
        return fmt::format("{:016x}{:016x}", first, finish());
    }

private:
    void add_word(std::uint64_t m) {
        v_[3] ^= m;
        round(), round();
        v_[0] ^= m;
    }
    void round() {
        auto& [a, b, c, d] = v_;
        a += b, b = std::rotl(b, 13) ^ a, a = std::rotl(a, 32);
        c += d, d = std::rotl(d, 16) ^ c;
        a += d, d = std::rotl(d, 21) ^ a;
        c += b, b = std::rotl(b, 17) ^ c, c = std::rotl(c, 32);
    }
    std::array<std::uint64_t, 4> v_;
};

/// False for what is not there, and for links, pipes and the like.
bool is_plain_file(const std::string& path) {
    platform::FileStatus status;
    return !platform::is_link(path) && platform::status_of(path, status) == 0 && status.kind == platform::FileKind::file;
}

/// The key of a folder, which is made with it. Empty: there is none.
std::vector<std::byte> key_of(const std::string& folder) {
    const std::string path = folder + "/key";
    platform::FileStatus status;
    const bool is_there = platform::is_link(path) || platform::status_of(path, status) == 0;
    if (is_there && !is_plain_file(path)) return {};
    if (auto kept = read_file(path, kKeyBytes); kept && kept->size() == kKeyBytes) return *std::move(kept);
    std::error_code error;
    const std::filesystem::path place = platform::to_path(folder);
    if (std::filesystem::create_directories(place, error)) std::filesystem::permissions(place, std::filesystem::perms::owner_all, error);
    if (error) return {};
    std::random_device random;
    std::vector<std::uint8_t> key(kKeyBytes);
    for (std::uint8_t& byte : key) byte = static_cast<std::uint8_t>(random());
    if (!write_file(path, key)) return {};
    auto kept = read_file(path, kKeyBytes);  // another process may have made it too
    return kept && kept->size() == kKeyBytes ? *std::move(kept) : std::vector<std::byte>();
}

}  // namespace

ImportCache::ImportCache(const std::string& folder, const std::vector<std::string>& words, std::span<const std::byte> input)
    : folder_(folder) {
    platform::FileStatus program;
    if (folder.empty() || platform::status_of(words.at(0), program) != 0) return;
    const std::vector<std::byte> key = key_of(folder);
    if (key.empty()) return;
    SipHash hash(key);
    for (const std::string& word : words) hash.add(word);
    hash.add(fmt::format("{} {}", program.bytes, program.changed_ns));
    hash.add(input);
    path_ = folder + "/" + hash.hex() + ".glb";
    key_ = key;
}

/// Behind the GLB in its file.
std::string ImportCache::seal_of(std::span<const std::byte> glb) const {
    SipHash hash(key_);
    hash.add(glb);
    return hash.hex();
}

std::optional<std::vector<std::byte>> ImportCache::find() const {
    if (path_.empty() || !is_plain_file(path_)) return std::nullopt;
    auto kept = read_file(path_, kMostOfOne + kSealBytes);
    if (!kept || kept->size() < kSealBytes) return std::nullopt;
    const std::span<const std::byte> glb = std::span(*kept).first(kept->size() - kSealBytes);
    if (as_text(std::span(*kept).subspan(glb.size())) != seal_of(glb)) return std::nullopt;  // it was damaged there
    kept->resize(glb.size());
    std::error_code ignored;
    std::filesystem::last_write_time(platform::to_path(path_), std::filesystem::file_time_type::clock::now(), ignored);
    return *std::move(kept);
}

void ImportCache::keep(std::span<const std::byte> glb) const {
    if (path_.empty() || glb.size() > kMostOfOne) return;
    if (platform::is_link(path_)) (void)platform::remove_file(path_);
    const std::string seal = seal_of(glb);
    std::vector<std::uint8_t> bytes_of_file(glb.size());
    std::memcpy(bytes_of_file.data(), glb.data(), glb.size());
    bytes_of_file.insert(bytes_of_file.end(), seal.begin(), seal.end());
    if (!write_file(path_, bytes_of_file)) return;
    constexpr std::size_t kMostFiles = 100'000;
    std::vector<std::tuple<std::int64_t, std::uint64_t, std::string>> all;  // age, bytes, path
    std::uint64_t bytes = 0;
    for (const std::string& name : platform::names_in(folder_, kMostFiles)) {
        platform::FileStatus status;
        const std::string path = folder_ + "/" + name;
        if (!name.ends_with(".glb") || platform::status_of(path, status) != 0) continue;
        bytes += status.bytes;
        all.emplace_back(platform::age_ns(status), status.bytes, path);
    }
    std::sort(all.rbegin(), all.rend());
    for (std::size_t i = 0; i < all.size() && bytes > kMostKept; ++i)
        if (platform::remove_file(std::get<2>(all[i])) == 0) bytes -= std::get<1>(all[i]);
}

std::string user_folder(const char* variable, const char* usual) {
    const auto value_of = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::string(value == nullptr ? "" : value);
    };
    if (const std::string own = value_of(variable); platform::is_absolute(own)) return own;
    const std::string home = value_of("HOME");
    platform::FileStatus status;  // a home that is not there is not made
    return platform::is_absolute(home) && platform::status_of(home, status) == 0 ? home + "/" + usual : "";
}

std::string user_import_cache() {
    const std::string folder = user_folder("XDG_CACHE_HOME", ".cache");
    return folder.empty() ? "" : folder + "/halflit/import";
}

}  // namespace halflit::io::detail
