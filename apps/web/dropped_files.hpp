// Files in memory: those that a visitor dropped on the page, or that a host handed over. dropped_files.cpp answers
// apps/io/files/file_access.hpp from them.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace halflit::web {

/// Files by their plain names, and the names that models asked for and that are not there, each once.
struct FileStore {
    std::map<std::string, std::vector<std::byte>, std::less<>> files;
    std::vector<std::string> wanted;
};

/// From now on, files are those of this store, which outlives its use; null: there are none.
void use_files(FileStore* store);

/// Adds or replaces a file of the store in use. `name` may have folders before it, with '/'. The bytes are valid until then.
std::vector<std::byte>& add_file(const std::string& name, std::vector<std::byte> bytes);

}  // namespace halflit::web
