#include "apps/io/gltf/file/notes.hpp"

#include <utility>

namespace halflit::io::detail {

void Notes::add_fault(Budget& memory, Note note) {
    if (!faults.empty() && faults.back().owner == note.owner) return;
    memory.take(2 * sizeof(Note) + note.what.size());
    faults.push_back(std::move(note));
}

void Notes::add_warning(Note note) {
    if (warnings.size() < kMostWarnings)
        warnings.push_back(std::move(note));
    else
        ++warnings_left_out;
}

}  // namespace halflit::io::detail
