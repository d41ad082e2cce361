// Calls from languages that hand over a name and arguments as JSON.
#pragma once

#include "apps/engine/calls/call.hpp"

#include <cstdint>
#include <string>

namespace halflit::engine {

class SceneKeeper;

/// The model of a call: that of its arguments, a caller's in its place, or, for a check, any.
enum class ModelOf : std::uint8_t { arguments, caller, any };

/// True if one model is drawn, which the argument `path` names.
[[nodiscard]] bool takes_path(const CallRow& row);

/// arguments: a JSON object; null: none. path: the name of the caller's model, or of any; "demo" needs no file.
[[nodiscard]] Result<Call> call_of_text(const char* name, const char* arguments, ModelOf model, const std::string& path = "demo");

/// Fails as the call would before it loads a model.
[[nodiscard]] Result<void> check_call(const Call& call);

/// Runs the call within its time limit. keeper: has the models; null: they are loaded.
[[nodiscard]] Result<Answer> answer_call(const Call& call, SceneKeeper* keeper);

}  // namespace halflit::engine
