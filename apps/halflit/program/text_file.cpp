#include "apps/halflit/program/text_file.hpp"

#include "apps/io/files/atomic_file.hpp"

namespace halflit::cli {

Result<void> write_text(const std::string& path, const std::string& text) {
    return io::write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace halflit::cli
