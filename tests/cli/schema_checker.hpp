// A checker of the part of JSON Schema that the schemas of reports use.
#pragma once

#include <nlohmann/json.hpp>

#include <set>
#include <string>

namespace halflit::test {

/// It is stricter than the standard: an object may have no key that the schema does not describe.
class Schema {
public:
    /// "KIND-1.schema.json"
    explicit Schema(const std::string& file);
    /// The first fault, as a path and a reason; empty: none.
    [[nodiscard]] std::string fault(const nlohmann::json& value) const { return check(value, root_, file_, "", true); }

    /// Keys of the schema language that the checker met and does not know.
    [[nodiscard]] const std::set<std::string>& unknown() const { return unknown_; }

private:
    struct Place {
        nlohmann::json schema;
        std::string file;
    };
    [[nodiscard]] Place resolved(const std::string& ref, const std::string& file) const;
    void collect_keys(const nlohmann::json& schema, const std::string& file, std::set<std::string>& keys) const;
    /// `whole`: no other schema describes this value too, so that unknown keys are faults.
    [[nodiscard]] std::string check(const nlohmann::json& value, const nlohmann::json& schema, const std::string& file,
                                    const std::string& path, bool whole) const;

    std::string file_;
    nlohmann::json root_;
    mutable std::set<std::string> unknown_;
};

}  // namespace halflit::test
