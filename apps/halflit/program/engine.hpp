// The program speaks of the engine's types by their names alone.
#pragma once

namespace halflit::engine {}
namespace halflit::cli {
using namespace engine;
}
