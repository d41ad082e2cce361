// Faults that are known and open, and a name for the fault that a scene shows.
#pragma once

#include "tests/adversary/evaluate.hpp"

#include <span>
#include <string>

namespace halflit::adversary {

/// A known fault. `open`: its scene still breaks the promise, and the search avoids the parts that it needs. When it is cured, `open`
/// becomes false: then the scene must keep the promise, and the search avoids nothing for it.
struct KnownFault {
    const char* what;    ///< in words
    AvoidSet avoid;      ///< parts of a scene without which it does not show
    const char* genome;  ///< a scene that shows it, found by the search and made small
    bool open;
};

[[nodiscard]] std::span<const KnownFault> known_faults();

/// Parts that the search leaves out because of open faults.
[[nodiscard]] AvoidSet avoided();

/// The open faults that explain a promise broken by the genome with `avoid`: those without whose parts the scene keeps it. Empty if the
/// scene breaks it without the parts of all of them.
[[nodiscard]] std::string explanation(Judge& judge, const Genome& genome, AvoidSet avoid);

}  // namespace halflit::adversary
