#pragma once
// The MTL files that an OBJ file names.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/mtl.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace halflit::io::detail {

/// Materials by their names. They are made, and their pictures read, when a face uses them.
class MtlLibraries {
public:
    explicit MtlLibraries(ModelBuilder& builder) : builder_(builder), pictures_(builder) {}

    /// mtllib: one name, which may have blanks in it, or several.
    void add(std::string_view names) {
        if (names.find_first_of(" \t") == std::string_view::npos) return void(read(names, false));
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
    /// The scene's material; -1: none of that name.
    int find(const std::string& name) {
        const auto known = number_of_.find(name);
        if (known == number_of_.end()) {
            builder_.document().warn(fmt::format("usemtl {}: no material of this name was read; drawn in grey", printable(name, 80)));
            return -1;
        }
        int& made = made_[known->second];
        if (made < 0) made = make_material(materials_[known->second], builder_, pictures_);
        return made;
    }
    /// Notes the files of all materials.
    void add_files() {
        for (const MtlMaterial& m : materials_)
            for (const MtlTexture* map : {&m.map_kd, &m.map_ks, &m.map_ke, &m.map_d, &m.map_pr, &m.map_pm, &m.bump, &m.norm})
                if (!map->file.empty()) builder_.add_file(map->file);
    }

private:
    /// Reads a library; false where it cannot be read, of which it warns unless `quietly`.
    bool read(std::string_view name, bool quietly) {
        check_time();
        Document& document = builder_.document();
        builder_.add_file(name);
        const auto bytes = document.read_named(ModelBuilder::file_name(name));
        const std::string shown = "mtllib " + printable(name, 120);
        if (!bytes) {
            if (!quietly) document.warn(fmt::format("{}: {}; its materials are drawn in grey", shown, bytes.error().message));
            return false;
        }
        document.encoded_images.take(bytes->size());
        const std::size_t first = materials_.size();
        read_mtl({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, shown, builder_, materials_);
        made_.resize(materials_.size(), -1);
        for (std::size_t i = first; i < materials_.size(); ++i) number_of_.try_emplace(materials_[i].name, i);
        return true;
    }

    ModelBuilder& builder_;
    MtlPictures pictures_;
    std::vector<MtlMaterial> materials_;
    std::vector<int> made_;
    std::unordered_map<std::string, std::size_t> number_of_;
};

}  // namespace halflit::io::detail
