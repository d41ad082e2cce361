#include "apps/halflit/report/schemas.hpp"

#include "sh/config.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace halflit::cli {
namespace {

struct SchemaFile {
    std::string_view name, text;
};

constexpr SchemaFile kSchemaFiles[] = {
#include "schemas.inc"  // made of docs/schema/*.json
};

/// A place in a schema's file.
struct SchemaPlace {
    std::string file, pointer;

    explicit SchemaPlace(std::string_view place) : file(place.substr(0, place.find('#'))) {
        if (file.size() < place.size()) pointer = place.substr(file.size() + 1);
    }
    [[nodiscard]] Json read() const {
        const auto* const found =
            std::find_if(std::begin(kSchemaFiles), std::end(kSchemaFiles), [&](const SchemaFile& one) { return one.name == file; });
        HALFLIT_ASSERT(found != std::end(kSchemaFiles));
        return Json::parse(found->text).at(Json::json_pointer(pointer));
    }
    /// "look-1_view": unlike that of any other place, as the files have no two definitions and properties of one name.
    [[nodiscard]] std::string name() const { return file.substr(0, file.find('.')) + "_" + pointer.substr(pointer.rfind('/') + 1); }
};

/// Follows the references of a schema, and collects what they lead to.
class SchemaCollector {
public:
    /// Replaces references in a schema of that file by those into the collection.
    void collect(Json& schema, const std::string& file) {
        if (schema.is_object())
            if (const auto ref = schema.find("$ref"); ref != schema.end()) {
                const auto text = ref->get<std::string>();
                const SchemaPlace place(text.starts_with('#') ? file + text : text);
                *ref = "#/$defs/" + place.name();
                if (!definitions.contains(place.name())) {
                    definitions[place.name()] = nullptr;  // so that a schema may refer to itself
                    Json definition = place.read();
                    collect(definition, place.file);
                    definitions[place.name()] = std::move(definition);
                }
            }
        if (schema.is_structured())
            for (Json& one : schema) collect(one, file);
    }

    Json definitions = Json::object();
};

}  // namespace

Json whole_schema(std::string_view place) {
    const SchemaPlace of(place);
    Json schema = of.read();
    for (const char* const key : {"$schema", "$id", "$defs"}) schema.erase(key);
    SchemaCollector collector;
    collector.collect(schema, of.file);
    schema["type"] = "object";
    if (!collector.definitions.empty()) schema["$defs"] = std::move(collector.definitions);
    return schema;
}

}  // namespace halflit::cli
