// ZIP files: what is in them, and what is refused.
#include "apps/io/files/zip_file.hpp"
#include "apps/io/files/load_failure.hpp"
#include "tests/io/model_maker.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <optional>

using namespace halflit;
using namespace halflit::io::detail;
using namespace halflit::test;

namespace {

std::span<const std::byte> view(const Bytes& bytes) { return bytes; }

/// An entry's bytes; nothing if there is no such entry. Throws as ZipFile.
std::optional<Bytes> unpacked(const Bytes& zip, std::string_view name) {
    const ZipFile file(view(zip));
    const ZipFile::Entry* const entry = file.find(name);
    if (entry == nullptr) return std::nullopt;
    file.check_size(*entry);
    Bytes out(entry->bytes);
    file.unpack(*entry, out);
    return out;
}

std::string refusal(const Bytes& zip, std::string_view name) {
    try {
        (void)unpacked(zip, name);
    } catch (const LoadFailure& failure) {
        return failure.error.message;
    }
    return "";
}

Bytes long_text() {
    Bytes text;
    for (int i = 0; i < 3000; ++i) append_bytes(text, "line " + std::to_string(i * i) + "\n");
    return text;
}

Bytes zip_of_three(bool packed) { return zip_of({{"a.txt", to_bytes("first")}, {"Dir/B.txt", long_text()}, {"empty", {}}}, packed); }

/// Adds a directory of 64 bits behind a ZIP file's own, whose numbers then say nothing.
Bytes with_large_numbers(Bytes zip) {
    const std::size_t end = zip.size() - 22;
    const auto number = [&](std::size_t at, int size) {
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) value |= std::to_integer<std::uint64_t>(zip[at + static_cast<std::size_t>(i)]) << (8 * i);
        return value;
    };
    const std::uint64_t entries = number(end + 10, 2), size = number(end + 12, 4), first = number(end + 16, 4);
    Bytes large;
    append_u32(large, 0x06064b50);
    append<std::uint64_t>(large, {44});
    append<std::uint16_t>(large, {45, 45});
    append<std::uint32_t>(large, {0, 0});
    append<std::uint64_t>(large, {entries, entries, size, first});
    append_u32(large, 0x07064b50);
    append<std::uint32_t>(large, {0});
    append<std::uint64_t>(large, {end});
    append<std::uint32_t>(large, {1});
    Bytes out(zip.begin(), zip.begin() + static_cast<std::ptrdiff_t>(end));
    out.insert(out.end(), large.begin(), large.end());
    append_u32(out, 0x06054b50);
    append<std::uint16_t>(out, {0, 0, 0xffff, 0xffff});
    append<std::uint32_t>(out, {0xffffffff, 0xffffffff});
    append<std::uint16_t>(out, {0});
    return out;
}

}  // namespace

TEST_CASE("zip: entries are found by name and unpacked, stored ones and deflated ones", "[io][zip]") {
    for (const bool packed : {false, true}) {
        Bytes zip = zip_of_three(packed);
        for (int i = 0; i < 4; ++i) {
            INFO("packed " << packed << ", variant " << i);
            CHECK(unpacked(zip, "a.txt") == to_bytes("first"));
            CHECK(unpacked(zip, "dir/b.TXT") == long_text());
            CHECK(unpacked(zip, "empty") == Bytes());
            CHECK_FALSE(unpacked(zip, "b.txt"));
            if (i == 0) zip = with_large_numbers(zip);
            if (i == 1) zip = zip_of_three(packed), zip[zip.size() - 2] = std::byte{4}, append_bytes(zip, "PK\5\6");  // a comment
            if (i == 2) {
                zip = packed ? with_large_numbers(zip_of_three(packed)) : zip_of_three(packed);
                const Bytes before = to_bytes("#!/bin/sh\nexit\n");
                zip.insert(zip.begin(), before.begin(), before.end());
            }
        }
    }
}

TEST_CASE("zip: what cannot be unpacked is refused by name", "[io][zip]") {
    const Bytes zip = zip_of_three(true);
    const auto entry = [&](const char* name) {
        Bytes mark;
        append_bytes(mark, name);
        const auto at = std::find_end(zip.begin(), zip.end(), mark.begin(), mark.end());
        return static_cast<std::size_t>(at - zip.begin()) - 46;  // in the directory
    };
    const auto changed = [&](std::size_t at, int value) {
        Bytes out = zip;
        out[at] = static_cast<std::byte>(value);
        return out;
    };
    const auto flipped = [&](std::size_t at) { return std::to_integer<int>(zip[at]) ^ 1; };
    const std::size_t b = entry("Dir/B.txt");
    CHECK(refusal(changed(b + 8, 1), "Dir/B.txt").find("encrypted") != std::string::npos);
    CHECK(refusal(changed(b + 10, 14), "Dir/B.txt").find("method 14") != std::string::npos);
    CHECK(refusal(changed(b + 16, flipped(b + 16)), "Dir/B.txt").find("checksum") != std::string::npos);
    CHECK(refusal(changed(b + 27, 0x7f), "Dir/B.txt").find("cannot come of") != std::string::npos);  // 2 GiB of a few kB
    CHECK(refusal(changed(b + 24, flipped(b + 24)), "Dir/B.txt").find("damaged") != std::string::npos);
    CHECK(refusal(changed(b + 44, 0x7f), "a.txt").find("damaged") != std::string::npos);  // begins outside of the file
    CHECK(refusal(to_bytes("PK\3\4"), "a.txt").find("no directory") != std::string::npos);
}

TEST_CASE("zip: files that are cut or damaged anywhere give the entry, nothing, or a refusal", "[io][zip]") {
    for (const Bytes& zip : {zip_of_three(false), with_large_numbers(zip_of_three(true))}) {
        for (std::size_t size = 0; size < zip.size(); size += size + 200 < zip.size() && size > 200 ? 97 : 1)
            CHECK_FALSE(refusal(Bytes(zip.begin(), zip.begin() + static_cast<std::ptrdiff_t>(size)), "a.txt").empty());
        for (std::size_t at = 0; at < zip.size(); ++at) {
            if (at > 200 && at + 400 < zip.size() && at % 53 != 0) continue;
            for (const std::byte flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xff}}) {
                Bytes damaged = zip;
                damaged[at] ^= flip;
                std::optional<Bytes> got;
                try {
                    got = unpacked(damaged, "a.txt");
                } catch (const LoadFailure&) {
                    continue;
                }
                if (got) CHECK(*got == to_bytes("first"));
            }
        }
    }
}
