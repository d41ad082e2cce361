#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

using namespace halflit::test;

namespace {

/// Checks for an error of one line by the program, with nothing on standard output.
void check_error(const Outcome& outcome, int code, const std::string& part) {
    INFO(outcome.err);
    CHECK(outcome.code == code);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("halflit: error: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK(outcome.err.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("usage: an invalid command line ends with 2 and says what was expected", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{}, "no scene and no command: expected halflit SCENE [PICTURE], or one of render"},
        {{"rendr"}, "did you mean render?"},
        {{"demmo"}, "unknown command demmo (did you mean demo?)"},
        {{"help", "rendr"}, "did you mean render?"},
        {{"render", "demo", "sphere:500"}, "unexpected argument sphere:500: several scenes need -o FOLDER/"},
        {{"render", "demo", "picture.gif"}, "picture.gif: expected --frames or --turntable"},
        {{"render", "demo", "a.png", "-o", "b.png"}, "the picture is named by -o b.png"},
        {{"render", "demo", "./demo", "-o", "out/", "--report", "r.json"}, "./demo: demo has the same picture out/demo.png"},
        {{"render", "--camera-position", "1,2"}, "3 numbers"},
        {{"render", "--time", "soon"}, "--time"},
        {{"render", "--time", "nan"}, "seconds"},
        {{"render", "--animation", ""}, "--animation"},
        {{"render", "--camera-position", "1,2,3", "--camera", "0"}, "--camera-position"},
        {{"render", "--camera-position", "1,2,3", "--camera", "frame"}, "--camera-position"},
        {{"render", "--camera-target", "1,2,3"}, "--camera-position"},
        {{"render", "--up", "w"}, "one of x, y, z, -x, -y, -z"},
        {{"render", "--specular", "phnog"}, "did you mean phong?"},
        {{"render", "--tonemap", "acse"}, "did you mean aces?"},
        {{"render", "--lobe", "lambret"}, "did you mean lambert?"},
        {{"render", "demo", "--resolution", "64x64"}, "unknown flag --resolution (did you mean --size?)"},
        {{"render", "demo", "--bg=white"}, "did you mean --background?"},
        {{"version"}, "did you mean --version?"},
        {{"demo", "--widht", "3"}, "unknown flag --widht (did you mean --size?)"},
        {{"--widht", "3", "demo"}, "unknown flag --widht (did you mean --size?)"},
        {{"--backgrond=white", "demo"}, "did you mean --background?"},
        {{"--siez", "8x8"}, "did you mean --size?"},
        {{"--size", "8x8"}, "--size: no scene and no command: expected halflit SCENE"},
        {{"nothing/modle.gbl"}, "nothing/modle.gbl: no such scene"},
        {{"--size", "10x10", "render"}, "--size stands before the command: expected halflit render --size"},
        {{"--size", "10x10", "render", "demo"}, "--size stands before the command: expected halflit render --size"},
        {{"--camera", "info", "demo"}, "--camera: expected an index below 1 or a camera's name, found 'info'"},
        {{"convert", "demo"}, "unknown command convert (did you mean render?)"},
        {{"lobe", "valv"}, "did you mean valve?"},
        {{"render", "--siez", "8x8"}, "did you mean --size?"},
        {{"render", "--zzzzzzzz"}, "unknown flag --zzzzzzzz"},
        {{"render", "demo", "extra"}, "unexpected argument extra"},
        {{"render", "--size"}, "--size"},
        {{"render", "--size", "0x0"}, "'0x0'"},
        {{"render", "--size", "-1"}, "'-1'"},
        {{"render", "--size", "8x8", "--size", "9x9"}, "--size"},
        {{"render", "--size", "8x"}, "WIDTHxHEIGHT"},
        {{"render", "--size", "8x8x8"}, "WIDTHxHEIGHT"},
        {{"render", "--samples", "3"}, "1, 4, 8 or 16"},
        {{"render", "--size", "8x8", "--region", "0,0,9,8"}, "8x8"},
        {{"render", "--region", "0,0,0,0"}, "X,Y,WIDTH,HEIGHT"},
        {{"render", "--background", "#12345"}, "#rrggbb"},
        {{"render", "--exposure", "bright"}, "auto"},
        {{"render", "--exposure", "nan"}, "auto"},
        {{"render", "--exposure", "auto1"}, "auto+1"},
        {{"render", "--exposure", "auto+"}, "auto+1"},
        {{"render", "--exposure", "auto+-1"}, "auto+1"},
        {{"render", "--exposure", "auto-65"}, "auto+1"},
        {{"render", "--exposure", "++1"}, "auto+1"},
        {{"render", "--camera", "9"}, "below 1"},
        {{"render", "--camera", "0", "--zoom", "2"}, "--zoom"},
        {{"render", "--lobe", "phong"}, "lambert"},
        {{"render", "--wrap", "1.5"}, "from 0 to 1"},
        {{"render", "--normalize"}, "--lobe"},
        {{"render", "--specular", "gouraud"}, "one of none, phong, blinn"},
        {{"render", "--ambient", "1,1"}, "3 numbers"},
        {{"render", "--ambient", "1,1,-1"}, "from 0"},
        {{"render", "--light", "sun"}, "directional"},
        {{"render", "--light", "point:dir=0,0,1"}, "pos"},
        {{"render", "--light", "directional:dir=0,0,0"}, "direction"},
        {{"render", "--isa", "mmx"}, "scalar"},
        {{"render", "--threads", "-1"}, "from 0"},
        {{"render", "--tile", "48"}, "16, 32 or 64"},
        {{"render", "-o", "picture.gif"}, "--turntable"},
        {{"render", "-o", ""}, "-o"},
        {{"render", "-o", "-", "--report", "-"}, "--report"},
        {{"render", "sphere:3"}, "from 12"},
        {{"bench"}, "SCENE"},
        {{"bench", "demo", "--frames", "0"}, "from 1"},
        {{"diff", "a.png"}, "B"},
        {{"diff", "a.png", "b.png", "--max", "256"}, "from 0 to 255"},
    };
    for (const auto& [arguments, part] : cases) {
        std::string line;
        for (const std::string& argument : arguments) line += " " + argument;
        INFO("halflit" << line);
        check_error(run(arguments, {.folder = folder.path()}), 2, part);
        CHECK(folder.names().empty());
    }
}

TEST_CASE("usage: a picture beyond 2^28 pixels ends with 5 before anything is loaded", "[cli]") {
    check_error(run({"render", "missing.glb", "--size", "100000x100000"}), 5, "2^28");
}

TEST_CASE("usage: a missing scene ends with 4 and the system's reason", "[cli]") {
    check_error(run({"render", "missing.glb", "-o", "-"}), 4, "missing.glb: cannot be opened: No such file or directory");
    check_error(run({"info", "missing.glb"}), 4, "No such file or directory");
}

TEST_CASE("usage: a folder is an error of its own, and -- ends the flags", "[cli]") {
    const TemporaryFolder folder;
    check_error(run({"info", folder.path()}), 4, "directory");
    check_error(run({folder.path()}), 2, "is a folder without models");
    CHECK(run({"-o", folder.file("a.png"), "--size", "8x8", "--", "demo"}).code == 0);
    CHECK(run({"--", "demo", folder.file("b.png")}).code == 0);
}

TEST_CASE("usage: a file that is not there is an error with the name of a file that is spelled alike", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("duck.glb"), "");
    const std::string meant = "did you mean duck.glb?";
    check_error(run({"render", "duck.gbl"}, {.folder = folder.path()}), 4, meant);
    check_error(run({"duk.glb"}, {.folder = folder.path()}), 4, meant);
    check_error(run({"duck.gbl"}, {.folder = folder.path()}), 2, meant);
    check_error(run({"diff", "duk.glb", "duck.glb"}, {.folder = folder.path()}), 4, meant);
    check_error(run({"render", folder.file("dukc.glb")}), 4, "did you mean " + folder.file("duck.glb"));
    check_error(run({"render", "sphere"}, {.folder = folder.path()}), 4, "did you mean sphere:N?");
    check_error(run({"render", "--env", "skyy"}, {.folder = folder.path()}), 4, "did you mean sky?");
    check_error(run({"render", "--env", "foo"}, {.folder = folder.path()}), 4, "--env: foo: cannot be opened");
}

TEST_CASE("usage: bytes that are no model end with 3", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("noise.glb"), "this is not a model");
    check_error(run({"render", folder.file("noise.glb"), "-o", "-"}), 3, "noise.glb");
    check_error(run({"render", "-", "-o", "-"}, {.input = "nor is this"}), 3, "standard input");
    check_error(run({"render", "-", "-o", "-"}), 3, "standard input");
}

TEST_CASE("usage: an endless standard input ends with 5", "[cli]") {
    check_error(run({"render", "-", "-o", "-", "--max-file-bytes", "1000"}, {.input = std::string(5000, ' ')}), 5, "--max-file-bytes");
}

TEST_CASE("usage: control characters of a name are shown, not sent to the terminal", "[cli]") {
    const Outcome outcome = run({"render", "a\x1b[31m\nb.glb", "-o", "-"});
    CHECK(outcome.code == 4);
    CHECK(outcome.err.find('\x1b') == std::string::npos);
    CHECK(outcome.err.find("a\\x1b[31m\\x0ab.glb") != std::string::npos);
}

TEST_CASE("usage: help and version go to standard output and end with 0", "[cli]") {
    const Outcome version = run({"--version"});
    CHECK(version.code == 0);
    CHECK(version.out.starts_with("halflit "));
    CHECK(version.out.find("pixel_epoch") != std::string::npos);
    CHECK(run({"-V"}).out == version.out);
    for (const std::string command : {"render", "bench", "info", "diff", "lobe", "env", "trade"}) {
        const Outcome help = run({command, "--help"});
        INFO(command);
        CHECK(help.code == 0);
        CHECK(help.err.empty());
        CHECK(help.out.find("Usage: halflit " + command) != std::string::npos);
        CHECK(run({command, "-h"}).out == help.out);
        CHECK(run({"help", command}).out == help.out);
    }
    CHECK(run({"help"}).out == run({"--help"}).out);
    CHECK(run({"-h"}).out == run({"--help"}).out);
}

TEST_CASE("usage: an argument without text is refused, as a variable that is not set gives it", "[cli]") {
    const TemporaryFolder folder;
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"render", "", "-o", "x.png"},
                                                      {"render", "demo", "-o", ""},
                                                      {"demo", "--env="},
                                                      {"render", "demo", "--report="},
                                                      {"", "-o", "x.png"},
                                                      {"info", ""}}) {
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("empty") != std::string::npos);
        CHECK(folder.names().empty());
    }
}
