#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/calls/call.hpp"
#include "apps/engine/job/built_in_scenes.hpp"

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

using Value = nlohmann::json;

bool is_digits(const std::string& word) { return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos; }

/// Words of a form that are values themselves; empty if one of them stands for something.
std::vector<std::string> choices_of(const std::string& form) {
    std::vector<std::string> words = words_of(form, '|');
    const auto stands_for = [](const std::string& word) {
        return std::any_of(word.begin(), word.end(), [](char c) { return (c >= 'A' && c <= 'Z') || c == '.'; });
    };
    if (words.size() < 2 || std::any_of(words.begin(), words.end(), stands_for)) words.clear();
    return words;
}

Json type_of(const Flag& flag) {
    if (flag.form.empty()) return {{"type", "boolean"}};
    const std::vector<std::string> choices = choices_of(flag.form);
    if (!choices.empty() && std::all_of(choices.begin(), choices.end(), is_digits)) {
        Json numbers = Json::array();
        for (const std::string& choice : choices) numbers.push_back(std::stoi(choice));
        return {{"type", "integer"}, {"enum", std::move(numbers)}};
    }
    if (!choices.empty()) return {{"type", "string"}, {"enum", choices}};
    const bool number = takes_number(flag) && flag.form.find('|') == std::string::npos;  // some hosts take no list of types
    return {{"type", number ? "number" : "string"}};
}

/// The first sentences of a help, as many as stay short: an agent pays for each word of each tool.
std::string brief(const std::string& help) {
    constexpr std::size_t kMostBytes = 120;
    std::size_t end = help.find(". ");
    for (std::size_t next = end; next != std::string::npos && next <= kMostBytes; next = help.find(". ", next + 1)) end = next;
    if (end == std::string::npos || help.size() <= kMostBytes) return help;
    return help.substr(0, end);
}

Json property_of(const Flag& flag) {
    Json property = flag.repeated ? Json{{"type", "array"}, {"items", type_of(flag)}} : type_of(flag);
    const bool explains = !flag.form.empty() && choices_of(flag.form).empty() && flag.form.find_first_of("|,:=") != std::string::npos;
    property["description"] = (explains ? flag.form + ": " : "") + brief(flag.help);
    return property;
}

std::string argument_of(const Flag& flag) { return flag.long_name().substr(2); }

/// By any of its names. Underscores count as hyphens, as languages have no names with hyphens.
const Flag* find_flag(const Call& call, std::string name) {
    std::replace(name.begin(), name.end(), '_', '-');
    const std::string word = "--" + name;
    for (const FlagGroup& group : call.groups)
        for (const Flag& flag : group.flags) {
            const std::vector<std::string> names = words_of(flag.names, ',');
            if (std::find(names.begin(), names.end(), word) != names.end()) return &flag;
        }
    return nullptr;
}

/// A value's text, as a command line would have it.
Result<std::string> text_of_value(const Flag& flag, const Value& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    if (value.is_array() && !value.empty() && std::all_of(value.begin(), value.end(), [](const Value& one) { return one.is_number(); })) {
        std::string text;
        for (const Value& one : value) text.append(text.empty() ? "" : ",").append(one.dump());
        return text;
    }
    if (value.is_boolean() && flag.form == "off|on") return std::string(value.get<bool>() ? "on" : "off");
    return fail(ErrorCode::usage, std::string("expected ") + (flag.form.empty() ? "true or false" : flag.form) +
                                      ", found a value of type " + value.type_name());
}

Result<void> read_text_of(const Flag& flag, std::string text, const ResolvePath& resolve) {
    const std::vector<std::string> words = words_of(flag.form, '|');
    const auto named = [&](const std::string& word) { return std::find(words.begin(), words.end(), word) != words.end(); };
    if (text.empty() && !flag.form.empty()) return fail(ErrorCode::usage, "expected a value, found nothing");
    if (text.find('\0') != std::string::npos) return fail(ErrorCode::usage, "expected text without zero bytes");
    const bool built_in = named(kModelForm) && is_built_in_name(text);
    const bool reads = named(kModelForm) || named(kFileForm), writes = named(kPictureForm);
    if ((reads || writes) && !named(text) && !built_in) {
        auto path = resolve(text, reads ? PathUse::read : PathUse::write);
        if (!path) return tl::unexpected(path.error());
        text = std::move(*path);
    }
    return flag.read(text);
}

Result<void> read_argument(const Flag& flag, const Value& value, const ResolvePath& resolve) {
    constexpr std::size_t kMostValues = 1000;
    if (value.is_null()) return {};
    if (flag.form.empty()) {
        if (!value.is_boolean())
            return fail(ErrorCode::usage, std::string("expected true or false, found a value of type ") + value.type_name());
        return value.get<bool>() ? flag.read("") : Result<void>();
    }
    if (value.is_array() && flag.repeated && !(!value.empty() && value.front().is_number())) {
        if (value.size() > kMostValues) return fail(ErrorCode::usage, "expected at most " + std::to_string(kMostValues) + " values");
        for (const Value& one : value) {
            auto text = text_of_value(flag, one);
            if (!text) return tl::unexpected(text.error());
            if (const auto read = read_text_of(flag, std::move(*text), resolve); !read) return read;
        }
        return {};
    }
    auto text = text_of_value(flag, value);
    if (!text) return tl::unexpected(text.error());
    return read_text_of(flag, std::move(*text), resolve);
}

}  // namespace

Result<const CallRow*> find_call(std::string_view name) {
    std::vector<std::string> names;
    for (const CallRow& row : all_calls()) {
        if (row.name == name) return &row;
        names.push_back(row.name);
    }
    const std::string hint = did_you_mean(std::string(name), names);
    return fail(ErrorCode::usage,
                "unknown call '" + std::string(name) + "'" + (hint.empty() ? ", expected one of " + joined(names, ", ") : hint));
}

Json arguments_schema(const CallRow& row, const Call& call) {
    Json properties = Json::object();
    for (const std::string_view name : row.shown)
        if (const Flag* const flag = find_flag(call, std::string(name))) properties[std::string(name)] = property_of(*flag);
    return {{"type", "object"}, {"properties", std::move(properties)}, {"required", row.required}};
}

Result<void> read_arguments(const CallRow& row, const Call& call, const Value& arguments, const ResolvePath& resolve) {
    for (const auto& [name, value] : arguments.items()) {
        const Flag* const flag = find_flag(call, name);
        if (flag == nullptr) {
            std::vector<std::string> names;
            for (const FlagGroup& group : call.groups)
                for (const Flag& one : group.flags) names.push_back(argument_of(one));
            const std::string hint = did_you_mean(name, names);
            std::vector<std::string> shown(row.shown.begin(), row.shown.end());
            std::erase_if(shown, [&](const std::string& word) { return find_flag(call, word) == nullptr; });
            return fail(ErrorCode::usage, row.name + ": unknown argument '" + name + "'" +
                                              (hint.empty() ? ", expected some of " + joined(shown, ", ") : hint));
        }
        if (const auto read = read_argument(*flag, value, resolve); !read)
            return fail(read.error().code, name + ": " + read.error().message);
    }
    for (const std::string_view name : row.required)
        if (const auto found = arguments.find(std::string(name)); found == arguments.end() || found->is_null())
            return fail(ErrorCode::usage, row.name + ": expected the argument '" + std::string(name) + "'");
    return {};
}

}  // namespace halflit::engine
