// A scene that stays loaded between two pictures, as the page keeps it: each flag says which stage it makes anew.
#include "apps/web/picture_session.hpp"
#include "apps/engine/request/render_options.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace halflit::web {
namespace {

using Words = std::vector<std::string>;

/// Values of flags that do not list theirs.
const std::map<std::string, std::string> kValues{{"--size", "40x40"},
                                                 {"--region", "4,4,20,20"},
                                                 {"--background", "red"},
                                                 {"--exposure", "auto+1"},
                                                 {"--samples", "4"},
                                                 {"--point-size", "3"},
                                                 {"--line-width", "2"},
                                                 {"--camera", "frame"},
                                                 {"--azimuth", "70"},
                                                 {"--elevation", "40"},
                                                 {"--zoom", "1.5"},
                                                 {"--fov", "60"},
                                                 {"--view", "top"},
                                                 {"--fit", "3"},
                                                 {"--camera-position", "3,4,5"},
                                                 {"--camera-orbit", "30deg 60deg auto"},
                                                 {"--camera-target", "0,1,0"},
                                                 {"--up", "z"},
                                                 {"--time", "1"},
                                                 {"--section", "x=50%"},
                                                 {"--section-spacing", ".1"},
                                                 {"--ambient", ".5,.4,.3"},
                                                 {"--env", "sky"},
                                                 {"--env-rotate", "90"},
                                                 {"--sh-order", "2"},
                                                 {"--sun-size", "5"},
                                                 {"--lamp-size", ".2"},
                                                 {"--shadow-memory", "1"},
                                                 {"--shadow-size", "64"},
                                                 {"--soft-shadow-maps", "4"},
                                                 {"--shadow-fade", "1"},
                                                 {"--shadow-softness", "8"},
                                                 {"--sky-shadows", "16"},
                                                 {"--contact-shadow", "0"},
                                                 {"--wrap", ".5"},
                                                 {"--power", "3"},
                                                 {"--kd", ".3"},
                                                 {"--ks", ".5"},
                                                 {"--shininess", "9"},
                                                 {"--crease", "90"},
                                                 {"--normal-scale", "0"},
                                                 {"--edge-color", "red"},
                                                 {"--edge-angle", "5"},
                                                 {"--edge-width", "3"},
                                                 {"--edl-strength", "2"},
                                                 {"--max-error", "2"},
                                                 {"--anisotropy", "16"},
                                                 {"--light", "point:pos=0,3,1:power=900"}};

bool is_word(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

std::uint64_t hash_of(PictureSession& session, const Words& flags) {
    const auto drawn = session.draw("sphere:2000", flags);
    if (!drawn) return drawn.error().message.size();  // both refuse it with the same words
    return pixel_hash(session.picture().rgba8);
}

/// What a flag changes only beside another one.
const std::map<std::string, Words> kBeside{{"--edge-color", {"--edges", "all"}},
                                           {"--edge-angle", {"--edges", "feature"}},
                                           {"--edge-width", {"--edges", "all"}},
                                           {"--hidden-edges", {"--edges", "all"}},
                                           {"--normalize", {"--wrap", "1"}},
                                           {"--power", {"--wrap", "1"}},
                                           {"--env-rotate", {"--env", "sky"}},
                                           {"--env-sun", {"--env", "sky"}},
                                           {"--sh-order", {"--env", "sky"}},
                                           {"--shadow-fade", {"--shadows", "soft-split", "--wrap", "1"}},
                                           {"--soft-shadow-maps", {"--sun-size", "5"}},
                                           {"--camera-target", {"--camera-position", "3,4,5"}}};

}  // namespace

TEST_CASE("web: a kept scene has the pixels of a new one after every flag", "[cli][web]") {
    engine::RenderOptions options;
    int tried = 0;
    for (const engine::FlagGroup& group : engine::render_flags(options, kUsualSize))
        for (const engine::Flag& flag : group.flags) {
            const std::string name = flag.long_name();
            const bool loads = flag.stage.value_or(group.stage) == engine::Stage::load;
            Words values;
            if (const auto value = kValues.find(flag.names.substr(0, flag.names.find(','))); value != kValues.end())
                values = {value->second};
            else if (flag.form.empty())
                values = {""};
            else
                for (const std::string& word : engine::words_of(flag.form, '|'))
                    if (is_word(word)) values.push_back(word);
            if (name == "--camera-file" || name == "--isa" || (loads && values.empty())) continue;
            INFO(name);
            REQUIRE_FALSE(values.empty());
            Words before{"--size", "48x32"};
            if (const auto beside = kBeside.find(name); beside != kBeside.end())
                before.insert(before.end(), beside->second.begin(), beside->second.end());
            PictureSession kept;
            const std::uint64_t first = hash_of(kept, before);
            for (const std::string& value : values) {
                Words flags = before;
                if (name == "--size") flags.clear();
                flags.push_back(name);
                if (!flag.form.empty()) flags.push_back(value);
                INFO(value);
                PictureSession fresh;
                CHECK(hash_of(kept, flags) == hash_of(fresh, flags));
                CHECK(hash_of(kept, before) == first);
                ++tried;
            }
        }
    CHECK(tried > 80);
}

}  // namespace halflit::web
