# The same pixels on other processors, systems and compilers. `dev` reads this file for ./dev test --arch, --debian, --windows and the like.
# Two programs test what could differ: the golden hashes, and every operation and kernel against scalar.
portable_targets=(halflit_golden_tests halflit_shading_tests)
portable_filter='[simd]~[slow]~[deep],[kernels]~[slow]~[deep],[pow]~[slow]~[deep],[isa]'

# run_portable FOLDER PREFIX...: both programs of build/FOLDER, each run by the command PREFIX.
run_portable() {
    local bin=$root/build/$1/bin
    shift
    "$@" "$bin/halflit_golden_tests"
    "$@" "$bin/halflit_shading_tests" "$portable_filter"
}

# ---- chroots of Debian --------------------------------------------------------------------------------------------------
# debian SUITE: makes build/chroots/SUITE, which is kept between runs.
debian() {
    local suite=$1 folder=$root/build/chroots/$1 mirror script=()
    [ ! -e "$folder/.whole" ] || return 0
    install debootstrap
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1)
    [ -n "$mirror" ] || fail "a chroot of Debian needs a mirror: apt here has none (apt-get update)"
    [ -e "/usr/share/debootstrap/scripts/$suite" ] || script=(sid)  # a suite that is newer than debootstrap
    echo "dev: making a chroot of Debian $suite" >&2
    "${as_root[@]}" rm -rf "$folder"
    mkdir -p "$root/build/chroots"
    "${as_root[@]}" debootstrap --variant=minbase "$suite" "$folder" "$mirror" "${script[@]}" >"$root/build/chroots/$suite.log" 2>&1 ||
        fail "debootstrap failed: see build/chroots/$suite.log"
    # Copies the settings by which this machine's apt reaches its mirror; not what it does after installing.
    { grep -lZE '^ *Acquire' /etc/apt/apt.conf.d/* 2>/dev/null || true; } | "${as_root[@]}" xargs -0 -r cp -t "$folder/etc/apt/apt.conf.d/"
    "${as_root[@]}" touch "$folder/.whole"
}

# in_debian SUITE COMMAND: runs a shell's line in the chroot, where the project lies, read-only, in /halflit, and /build may be written.
# Mounts end with it.
in_debian() {
    local suite=$1 as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "a chroot needs root: run as root, or install sudo"
        as_root=(sudo)
    fi
    debian "$suite"
    "${as_root[@]}" unshare --mount --fork bash -euc '
        chroot=$1 project=$2 command=$3
        mkdir -p "$chroot/halflit" "$chroot/build"
        mount -t proc proc "$chroot/proc"
        mount --rbind /dev "$chroot/dev"
        mount --bind "$project" "$chroot/halflit"
        mount -o remount,ro,bind "$chroot/halflit"
        cp /etc/resolv.conf "$chroot/etc/" 2>/dev/null || true
        exec chroot "$chroot" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive bash -euc "$command"
    ' bash "$root/build/chroots/$suite" "$root" "$2"
}

# --debian SUITE: what a new user does there, on a copy of the project.
test_debian() {
    in_debian "$1" '
        apt-get update -qq
        apt-get install -y -qq --no-install-recommends git >/dev/null
        mkdir -p /root/halflit
        cd /root/halflit
        find /root/halflit -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
        git config --global --add safe.directory /halflit
        git -C /halflit ls-files -z --cached --others --exclude-standard | (cd /halflit && xargs -0 ls -d 2>/dev/null) |
            tar -C /halflit -T - -c | tar -x
        ./dev render
        ./dev test --quick'
    echo "dev: Debian $1: passed"
}

# --arch ARCH
test_arch() { in_debian bookworm "/halflit/tests/machines/cross.sh $1 '$portable_filter'"; }

# --windows
test_windows() { in_debian bookworm "/halflit/tests/machines/windows.sh '$portable_filter'"; }

# ---- other processors of this family, browsers --------------------------------------------------------------------------
test_web() {
    local name
    install "${packages[@]}" "${test_packages[@]}" "${web_packages[@]}"
    build_checked web web -- "${portable_targets[@]}"
    for name in scalar wasm128; do
        HALFLIT_KERNEL=$name node --no-experimental-fetch "$root/build/web/bin/halflit_golden_tests.js"
    done
    node --no-experimental-fetch "$root/build/web/bin/halflit_shading_tests.js" "$portable_filter"
}

test_older_x86() {
    local pair
    install "${packages[@]}" "${test_packages[@]}" qemu-user
    build_checked release release -DHALFLIT_KERNEL_SETS= -DHALFLIT_VIEWER=ON -- "${portable_targets[@]}"
    for pair in qemu64=sse2 Nehalem=sse4.1 SandyBridge=sse4.1 Haswell=avx2; do
        echo "dev: qemu's ${pair%=*}, which has ${pair#*=}"
        run_portable release qemu-x86_64 -cpu "${pair%=*}" -U HALFLIT_KERNEL -E "HALFLIT_EXPECTED_KERNEL=${pair#*=}"
    done
}

# test_avx512 native|bochs|auto: on this processor, or on an emulated one (qemu has no AVX-512).
test_avx512() {
    local on=$1 bin
    if [ "$on" = auto ]; then
        on=bochs
        if grep -qw avx512f /proc/cpuinfo; then on=native; fi
    fi
    install "${packages[@]}" "${test_packages[@]}"
    if [ "$on" = native ]; then
        build_checked release release -DHALFLIT_KERNEL_SETS= -DHALFLIT_VIEWER=ON -- "${portable_targets[@]}"
        echo "dev: this processor, which has avx512"
        run_portable release env HALFLIT_KERNEL=avx512 HALFLIT_EXPECTED_KERNEL=avx512
        return
    fi
    install "${bochs_packages[@]}"
    build_checked static static -- halflit_shading_tests
    echo "dev: Bochs's Skylake-X, which has avx512: the kernels and the choice of the set; this takes minutes"
    bin=$root/build/static/bin/halflit_shading_tests
    "$root/tests/machines/run_in_bochs.sh" "$root/build/bochs" \
        "export HALFLIT_EXPECTED_KERNEL=avx512; $bin --use-colour no '[kernels]~[slow]~[deep],[isa]'" "$bin"
}

# ---- compilers and their flags ------------------------------------------------------------------------------------------
# golden_of NAME CMAKE_FLAGS...: golden hashes of a build by every instruction set of this processor.
golden_of() {
    local name=$1
    shift
    build_checked release "compilers/$name" -DHALFLIT_BUILD_IO=OFF "$@" -- halflit_golden_tests
    echo "dev: $name"
    ctest --test-dir "$root/build/compilers/$name" --output-on-failure -j "$(nproc)" -L golden
}

newest_clang() {
    apt-cache search --names-only '^clang-[0-9]+$' | sed 's/^clang-\([0-9]*\) .*/\1/' | sort -n | tail -n 1
}

test_compilers() {
    local compiler level newest flags
    newest=$(newest_clang)
    install "${packages[@]}" "${test_packages[@]}" dpkg-dev clang libc++-dev libc++abi-dev ${newest:+"clang-$newest"}
    for compiler in g++ clang++; do
        for level in 0 1 2 3; do
            golden_of "$compiler-O$level" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS_RELEASE="-O$level"
        done
    done
    [ -z "$newest" ] || golden_of "clang-$newest" -DCMAKE_CXX_COMPILER="clang++-$newest"
    golden_of libc++ -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-stdlib=libc++
    for flags in -march=x86-64-v2 -march=x86-64-v3 -march=native -flto; do
        golden_of "g++$flags" -DCMAKE_CXX_FLAGS="$flags" -DHALFLIT_WARNINGS_AS_ERRORS=OFF
    done
    # Flags that Debian builds its packages with.
    flags=$(DEB_BUILD_MAINT_OPTIONS='hardening=+all' dpkg-buildflags --get CXXFLAGS)
    golden_of hardening -DCMAKE_CXX_FLAGS="$flags $(DEB_BUILD_MAINT_OPTIONS='hardening=+all' dpkg-buildflags --get CPPFLAGS)" \
        -DCMAKE_EXE_LINKER_FLAGS="$(DEB_BUILD_MAINT_OPTIONS='hardening=+all' dpkg-buildflags --get LDFLAGS)"
    # Flags that change values are refused, with one line.
    for flags in -ffast-math -Ofast -ffinite-math-only; do
        ! (cd "$root" && cmake --preset release -B "build/compilers/refused" -DHALFLIT_BUILD_IO=OFF -DCMAKE_CXX_FLAGS_RELEASE="$flags" \
            >"$root/build/compilers/refused.txt" 2>&1) || fail "$flags is not refused"
        grep -q 'halflit: compile without' "$root/build/compilers/refused.txt" || fail "$flags is refused without a word"
        echo "dev: $flags is refused: $(grep -A1 'halflit: compile without' "$root/build/compilers/refused.txt" | tr -s ' \n' ' ')"
    done
}
