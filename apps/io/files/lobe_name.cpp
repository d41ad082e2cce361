#include "apps/io/files/lobe_name.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

namespace halflit::io {

Result<Lobe> lobe_from_name(std::string_view name, const LobeParameters& parameters) {
    const NamedLobe* model = find_named_lobe(name);
    if (model == nullptr)
        return fail(ErrorCode::bad_input, fmt::format("lobe: expected {}, found \"{}\"", lobe_names(), printable(name, 40)));
    Lobe lobe;
    lobe.wrap = model->takes_wrap ? parameters.wrap.value_or(kUsualWrap) : model->wrap;
    lobe.power = model->power + model->power_per_wrap * lobe.wrap;
    lobe.normalize = model->normalize;
    if (parameters.wrap) lobe.wrap = *parameters.wrap;
    if (parameters.power) lobe.power = *parameters.power;
    if (parameters.normalize) lobe.normalize = *parameters.normalize;
    if (const auto ok = check_lobe(lobe); !ok) return tl::unexpected(ok.error());
    return lobe;
}

}  // namespace halflit::io
