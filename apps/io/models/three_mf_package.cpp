#include "apps/io/models/three_mf_package.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <zip.h>

#include <algorithm>

namespace halflit::io::detail {

struct ThreeMfPackage::Archive {
    zip_t* zip = nullptr;

    explicit Archive(std::span<const std::byte> bytes) {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
        if (source != nullptr) zip = zip_open_from_source(source, ZIP_RDONLY, &error);
        if (zip == nullptr && source != nullptr) zip_source_free(source);
        const std::string text = zip == nullptr ? printable(zip_error_strerror(&error)) : "";
        const bool no_memory = zip_error_code_zip(&error) == ZIP_ER_MEMORY;
        zip_error_fini(&error);
        if (zip == nullptr)
            refuse("", fmt::format("the ZIP file of a 3MF model cannot be read: {}", text),
                   no_memory ? ErrorCode::limit : ErrorCode::bad_input);
    }
    ~Archive() {
        if (zip != nullptr) zip_discard(zip);
    }
    Archive(const Archive&) = delete;
    Archive& operator=(const Archive&) = delete;
};

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{64} << 20, kBytesPerByte = 200;

struct Closer {
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

ThreeMfPackage::ThreeMfPackage(std::span<const std::byte> bytes, Document& document)
    : document_(document),
      archive_(std::make_unique<Archive>(bytes)),
      unpacked_("its unpacked parts",
                std::min<std::uint64_t>(document.options.limits.max_total_bytes, kFreeBytes + kBytesPerByte * bytes.size())) {}

ThreeMfPackage::~ThreeMfPackage() = default;

void ThreeMfPackage::check_size(std::uint64_t bytes, const std::string& where) const {
    const std::uint64_t most = document_.options.limits.max_file_bytes;
    if (bytes > most) refuse(where, fmt::format("has more than {} bytes, which is max_file_bytes", most), ErrorCode::limit);
}

std::optional<std::vector<std::byte>> ThreeMfPackage::read(const std::string& name) {
    const std::string path = name.starts_with('/') ? name.substr(1) : name;
    const std::string where = printable(path, 120);
    const zip_int64_t index = zip_name_locate(archive_->zip, path.c_str(), ZIP_FL_NOCASE);
    if (index < 0) return std::nullopt;
    const auto number = static_cast<zip_uint64_t>(index);
    const auto failed = [&](const char* text) { refuse(where, fmt::format("cannot be unpacked: {}", printable(text))); };
    const std::unique_ptr<zip_file_t, Closer> file(zip_fopen_index(archive_->zip, number, 0));
    if (!file) failed(zip_strerror(archive_->zip));
    // The size that the package gives saves growing, and is refused at once where it is above the limit; what comes is counted all the
    // same.
    std::vector<std::byte> bytes;
    constexpr std::size_t kChunk = std::size_t{256} << 10;
    zip_stat_t told;
    if (zip_stat_index(archive_->zip, number, 0, &told) == 0 && (told.valid & ZIP_STAT_SIZE) != 0) {
        check_size(told.size, where);
        if (told.size > unpacked_.left()) unpacked_.take(told.size);
        bytes.reserve(static_cast<std::size_t>(told.size) + kChunk);
    }
    for (;;) {
        check_time();
        const std::size_t size = bytes.size();
        if (bytes.capacity() < size + kChunk) bytes.reserve(std::max(2 * bytes.capacity(), size + kChunk));
        bytes.resize(size + kChunk);
        const zip_int64_t got = zip_fread(file.get(), bytes.data() + size, kChunk);
        if (got < 0) failed(zip_file_strerror(file.get()));
        bytes.resize(size + static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
        if (got <= 0) break;
        unpacked_.take(static_cast<std::uint64_t>(got));
        check_size(bytes.size(), where);
    }
    return bytes;
}

}  // namespace halflit::io::detail
