#include "apps/io/lobe_name.hpp"

#include "apps/io/detail/text.hpp"

#include <fmt/format.h>

namespace halflit::io {

Result<shading::Lobe> lobe_from_name(std::string_view name, const LobeParameters& parameters) {
    const float wrap = parameters.wrap.value_or(0.5f);
    shading::Lobe lobe;
    if (name == "lambert")
        lobe = shading::Lobe::lambert();
    else if (name == "green")
        lobe = shading::Lobe::green(wrap);
    else if (name == "half-lambert")
        lobe = shading::Lobe::half_lambert();
    else if (name == "valve")
        lobe = shading::Lobe::valve();
    else if (name == "sloan")
        lobe = shading::Lobe::sloan(wrap);
    else if (name == "mcauley")
        lobe = shading::Lobe::mcauley(wrap, 1.0f + wrap);
    else
        return fail(ErrorCode::bad_input, fmt::format("lobe: expected lambert, green, half-lambert, valve, sloan or mcauley, found \"{}\"",
                                                      detail::printable(name, 40)));
    if (parameters.wrap) lobe.wrap = *parameters.wrap;
    if (parameters.power) lobe.power = *parameters.power;
    if (parameters.normalize) lobe.normalize = *parameters.normalize;
    if (const auto ok = shading::check_lobe(lobe); !ok) return tl::unexpected(ok.error());
    return lobe;
}

}  // namespace halflit::io
