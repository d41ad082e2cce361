// Values of a glTF file that break the schema. Reading goes on after them: whether one matters is known when the drawn elements are.
#pragma once

#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/file/target.hpp"
#include "apps/io/gltf/text/json_scan.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace halflit::io::detail {

/// An element of one of the file's arrays; Target::none is the file itself.
struct Owner {
    Target target = Target::none;
    std::uint32_t element = 0;
    friend bool operator==(const Owner&, const Owner&) = default;
};

struct Note {
    std::size_t offset = 0;  ///< of the value in the JSON text
    Owner owner;             ///< element that the value is part of
    std::string what;        ///< "3 is not in [0, 1]"
    std::string instead;     ///< what is done about it; empty for a fault
};

/// A member whose key comes again in its object: the offsets of its key, of the next member, and of the same key.
struct Twin {
    std::size_t first = 0, next = 0, again = 0;
};

struct Notes {
    static constexpr std::size_t kMostWarnings = 100;

    std::vector<Note> faults;    ///< refused if the owner is drawn. Of each owner the first alone
    std::vector<Note> warnings;  ///< the first ones
    std::size_t warnings_left_out = 0;
    std::vector<Twin> twins;

    /// Takes the note's memory from `memory`, as a file may hold millions of faults.
    void add_fault(Budget& memory, Note note);
    void add_warning(Note note);
};

}  // namespace halflit::io::detail
