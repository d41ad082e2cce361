#pragma once
// The MTL files that an OBJ file names.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/mtl.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace halflit::io::detail {

/// Materials by their names. They are made, and their pictures read, when a face uses them. The MTL file with the model's name serves for
/// those that are not found, as where files were renamed.
class MtlLibraries {
public:
    /// model_name: that of the OBJ file without its folder, or empty.
    MtlLibraries(ModelBuilder& builder, std::string_view model_name)
        : builder_(builder), pictures_(builder), own_name_(model_name.substr(0, model_name.rfind('.'))) {
        if (!own_name_.empty()) own_name_ += ".mtl";
    }

    /// mtllib: one name, which may have blanks in it, or several.
    void add(std::string_view names) {
        if (names.starts_with('"') || names.find_first_of(" \t") == std::string_view::npos) return void(read(unquoted(names), false));
        if (read(names, true)) return;
        std::vector<std::string_view> missing;
        bool any = false;
        Words words(names);
        for (std::string_view name = words.next(); !name.empty(); name = words.next()) {
            const bool is_read = read(name, true);
            any = any || is_read;
            if (!is_read) missing.push_back(name);
        }
        if (!any) return void(read(names, false));
        for (const std::string_view name : missing) read(name, false);
    }
    /// A statement of MTL in the OBJ file itself. False: it is none.
    bool take_statement(std::string_view word, TextScanner& scanner) {
        if (!within_) within_.emplace(builder_, materials_);
        if (!within_->take(word, scanner)) return false;
        if (materials_.size() > made_.size()) note_names();
        return true;
    }
    /// The scene's material; -1: none of that name.
    int find(const std::string& name) {
        const std::size_t found = look_up(name);
        if (found == kNoMaterial) {
            builder_.document().warn(fmt::format("usemtl {}: no material of this name was read; drawn in grey", printable(name, 80)));
            return -1;
        }
        int& made = made_[found];
        if (made < 0) made = make_material(materials_[found], builder_, pictures_);
        return made;
    }
    /// Its number; kNoMaterial: none of that name, nor in the MTL file with the model's.
    std::size_t look_up(const std::string& name) {
        const std::size_t found = find_named(name);
        return found == kNoMaterial && !builder_.options().strict && read_own() ? find_named(name) : found;
    }
    /// Notes the files of all materials.
    void add_files() {
        for (const MtlMaterial& m : materials_) add_pictures(m, builder_);
    }

private:
    static constexpr std::size_t kNoMaterial = static_cast<std::size_t>(-1);

    /// Reads a library; false where it cannot be read, of which it warns unless `quietly`.
    bool read(std::string_view name, bool quietly) {
        check_time();
        Document& document = builder_.document();
        const std::string file = ModelBuilder::file_name(name);
        if (const auto known = is_read_.find(file); known != is_read_.end()) return known->second;
        builder_.add_file(name);
        const auto bytes = document.read_named(file);
        const std::string shown = "mtllib " + printable(name, 120);
        if (!bytes && bytes.error().code != ErrorCode::bad_input) refuse(shown, bytes.error().message, bytes.error().code);
        if (!bytes) {
            if (quietly) return false;
            is_read_.emplace(file, false);
            if (!document.options.strict && read_own()) {
                document.warn(fmt::format("{}: {}; \"{}\" is read", shown, bytes.error().message, printable(own_name_, 120)));
                return true;
            }
            document.warn(fmt::format("{}: {}; its materials are drawn in grey", shown, bytes.error().message));
            return false;
        }
        is_read_.emplace(file, true);
        take_in(*bytes, shown);
        return true;
    }
    /// Reads the MTL file that has the model's name, once. False where there is none.
    bool read_own() {
        if (own_name_.empty() || own_is_tried_ || is_read_.contains(own_name_)) return false;
        own_is_tried_ = true;
        builder_.add_file(own_name_);
        std::string found;
        const auto bytes = builder_.document().read_named(own_name_, &found);
        if (!bytes && bytes.error().code != ErrorCode::bad_input) refuse("mtllib " + own_name_, bytes.error().message, bytes.error().code);
        if (!bytes) return false;
        is_read_.emplace(own_name_, true);
        builder_.document().warn(fmt::format("materials are those of \"{}\", which has the model's name", printable(found, 120)));
        take_in(*bytes, "mtllib " + printable(found, 120));
        return true;
    }
    void take_in(const std::vector<std::byte>& bytes, const std::string& shown) {
        builder_.document().encoded_images.take(bytes.size());
        read_mtl(as_text(bytes), shown, builder_, materials_);
        note_names();
    }
    void note_names() {
        const std::size_t first = made_.size();
        made_.resize(materials_.size(), -1);
        for (std::size_t i = first; i < materials_.size(); ++i) {
            number_of_.try_emplace(materials_[i].name, i);
            const auto [entry, is_new] = number_of_small_.try_emplace(small(materials_[i].name), i);
            if (!is_new && entry->second != kNoMaterial && materials_[entry->second].name != materials_[i].name)
                entry->second = kNoMaterial;  // several
        }
    }
    /// By its name, by its name up to a comment, or the only one whose letters differ in case alone.
    std::size_t find_named(const std::string& name) const {
        const std::size_t comment = std::min(name.find(" #"), name.size());
        for (const std::string& one : {name, name.substr(0, comment)})
            if (const auto known = number_of_.find(one); known != number_of_.end()) return known->second;
        if (builder_.options().strict) return kNoMaterial;
        const auto alike = number_of_small_.find(small(name));
        return alike == number_of_small_.end() ? kNoMaterial : alike->second;
    }
    static std::string small(std::string_view name) {
        std::string out(name);
        for (char& c : out) c = lower(c);
        return out;
    }

    ModelBuilder& builder_;
    MtlPictures pictures_;
    std::vector<MtlMaterial> materials_;
    std::vector<int> made_;
    std::unordered_map<std::string, std::size_t> number_of_, number_of_small_;
    std::optional<MtlText> within_;  ///< of statements in the OBJ file
    std::string own_name_;
    std::map<std::string, bool> is_read_;  ///< of libraries by their names; false: it is missing, of which it was warned
    bool own_is_tried_ = false;
};

}  // namespace halflit::io::detail
