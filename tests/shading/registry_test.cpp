// Listing, choosing and forcing instruction sets.
#include "halflit/isa.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <cstdlib>

using namespace halflit;
using namespace halflit::shading;

namespace {

/// Sets HALFLIT_KERNEL for a scope.
class KernelVariable {
public:
    explicit KernelVariable(const char* value) {
        if (const char* old = std::getenv("HALFLIT_KERNEL")) old_ = old, had_ = true;
        set(value);
    }
    ~KernelVariable() { set(had_ ? old_.c_str() : nullptr); }
    KernelVariable(const KernelVariable&) = delete;
    KernelVariable& operator=(const KernelVariable&) = delete;

private:
    static void set(const char* value) {
#ifdef _WIN32
        _putenv_s("HALFLIT_KERNEL", value != nullptr ? value : "");  // an empty value removes it
#else
        if (value != nullptr)
            setenv("HALFLIT_KERNEL", value, 1);
        else
            unsetenv("HALFLIT_KERNEL");
#endif
    }
    std::string old_;
    bool had_ = false;
};

}  // namespace

TEST_CASE("isa: scalar is built, comes first and is always available", "[shading][isa]") {
    REQUIRE(!built_isas().empty());
    CHECK(built_isas()[0] == Isa::scalar);
    CHECK(isa_available(Isa::scalar));
}

TEST_CASE("isa: every available set is found by its name", "[shading][isa]") {
    for (const Isa isa : built_isas())
        if (isa_available(isa)) CHECK(isa_by_name(isa_name(isa)).value() == isa);
}

TEST_CASE("isa: unknown and unavailable names are usage errors that list what there is", "[shading][isa]") {
    const auto result = isa_by_name("altivec");
    REQUIRE(!result);
    CHECK(result.error().code == ErrorCode::usage);
    CHECK(result.error().message.find("altivec") != std::string::npos);
    CHECK(result.error().message.find("scalar") != std::string::npos);
#if defined(__x86_64__)
    CHECK(!isa_by_name("neon64"));
    CHECK(!isa_available(Isa::neon64));
#else
    CHECK(!isa_by_name("avx2"));
#endif
}

TEST_CASE("isa: the default is the widest available, unless HALFLIT_KERNEL names another", "[shading][isa]") {
    Isa widest = Isa::scalar;
    for (const Isa isa : built_isas())
        if (isa_available(isa)) widest = isa;
    {
        const KernelVariable none(nullptr);
        CHECK(default_isa().value() == widest);
        CHECK(isa_by_name("auto").value() == widest);
    }
    {
        const KernelVariable forced("scalar");
        CHECK(default_isa().value() == Isa::scalar);
        CHECK(isa_by_name("auto").value() == Isa::scalar);
    }
    const KernelVariable wrong("sse9");
    REQUIRE(!default_isa());
    CHECK(default_isa().error().code == ErrorCode::usage);
    CHECK(default_isa().error().message.find("HALFLIT_KERNEL") != std::string::npos);
}

TEST_CASE("isa: this processor runs every set that is built", "[shading][isa]") {
    std::string missing;
    for (const Isa isa : built_isas())
        if (!isa_available(isa)) missing.append(" ").append(isa_name(isa));
    if (!missing.empty()) HALFLIT_SKIP("not run here, so not compared with scalar:" + missing);
    CHECK(missing.empty());
}

TEST_CASE("isa: the set in use is the one that HALFLIT_EXPECTED_KERNEL names", "[shading][isa]") {
    // Used on emulated processors: the caller knows which set such a processor must choose.
    const char* const expected = std::getenv("HALFLIT_EXPECTED_KERNEL");
    if (expected == nullptr) HALFLIT_SKIP("HALFLIT_EXPECTED_KERNEL is not set");
    const KernelVariable none(nullptr);
    CHECK(isa_name(default_isa().value()) == expected);
}
