// JSON Schemas of the reports, made from docs/answers.
//
// A table is a type, behind definitions (:NAME TYPE). Types: int, number and text, each with a range (0.., 0..1 or 4; of a text: of its
// length) and a text with a /pattern/; bool, null, any, true; "a" | "b" (words); [TYPE; range of its length]; { fields }; material_numbers
// and material_textures (of shading/material_properties.def); @:NAME (a definition), @KIND/NAME (a field of another table) and
// @KIND:NAME/FIELD; TYPE or TYPE. A field is a name, ? if it may be missing, and a type; * stands for all other names, ! says that there
// are none, and + @.. adds the fields of another object. A comment describes the field before it, or the object that begins.
#pragma once

#include "halflit/error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// Kinds of reports: "report", "look" and others.
[[nodiscard]] std::vector<std::string> answer_kinds();

/// The JSON Schema (2020-12) of a kind as text, whose references to others are KIND-1.schema.json. Fails (usage) for an unknown kind.
[[nodiscard]] Result<std::string> answer_schema(const std::string& kind);

}  // namespace halflit::engine
