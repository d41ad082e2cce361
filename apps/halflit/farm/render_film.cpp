#include "apps/halflit/farm/render_film.hpp"
#include "apps/halflit/farm/picture_report.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/film/film_writer.hpp"
#include "apps/engine/job/film_view.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/program/interrupt.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/progress_line.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/process.hpp"
#include "raster/quality.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <future>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace halflit::cli {
namespace {

/// A frame that was drawn.
struct Drawn {
    PictureFile file;  ///< without bytes
    Image* picture = nullptr;
    AovPlanes* planes = nullptr;
    RenderReport rendered;
    double load_ms = 0, prepare_ms = 0, pose_time_s = 0;
    Camera camera;
};

struct Encoded {
    double ms = 0;
    std::uint64_t file_hash = 0;  ///< 0: no file of its own
    AovFiles beside{};            ///< written; without bytes
};

class FilmRun {
public:
    FilmRun(PictureOptions& options, bool skip_existing)
        : options_(options), skip_existing_(skip_existing), whole_(options.film.range()), range_(whole_) {}

    Result<void> run() {
        if (const auto named = name_files(); !named) return named;
        if (options_.shard) {
            const auto mine = options_.shard->frames_of(whole_);
            if (!mine) return nothing_to_draw();
            range_ = *mine;
        }
        if (const auto checked = check_paths_of_all(); !checked) return checked;
        auto job = make_render_job(options_);
        if (!job) return tl::unexpected(job.error());
        job_ = &*job;
        if (const auto spared = spare_inputs_of_all(); !spared) return spared;
        for (const std::string& warning : job->warnings) print_warning(warning);
        for (const std::string& choice : job->choices) print_detail(choice);
        if (options_.film.frames && options_.film.animates() && job->animation() == nullptr && options_.film.turntable == 0)
            print_warning(job->source.name + ": no animation moves it; all frames are the same");
        if (const auto made = make_writer(); !made) return made;
        if (const auto drawn = draw_all(); !drawn) return drawn;
        return finish();
    }

    /// A line for each frame that was encoded.
    [[nodiscard]] const std::string& report() const { return report_; }

private:
    /// More shards than frames are no error, since a scheduler starts them all.
    Result<void> nothing_to_draw() {
        print_note(fmt::format("shard {} of {} has none of the {} frames", options_.shard->index, options_.shard->count, whole_.count()));
        return {};
    }

    /// The folder's files take the scene's name.
    Result<void> name_files() {
        std::string& output = options_.output;
        if (output.empty() && !options_.film.several_views()) hint_ = "; -o film.gif, .apng or .webp makes one file of them";
        if (output.empty() || output.ends_with('/')) {
            const std::string usual = default_output(options_.scene, options_.format);
            const std::string stem = stem_of(usual);
            output += stem + (options_.film.several_views() ? "_{view}" : "_{:04}") + usual.substr(stem.size());
        }
        film_format_ = film::film_format_of(output);
        if (film_format_ && options_.format)
            return fail(ErrorCode::usage, "--format: expected a pattern such as frame_{:04}.png as the output, found '" + output + "'");
        if (film_format_ && skip_existing_)
            return fail(ErrorCode::usage,
                        "--skip-existing: expected a pattern such as frame_{:04}.png as the output, found '" + output + "'");
        if (film_format_ && !options_.aovs.empty())
            return fail(ErrorCode::usage, "--aov: expected a file for each frame, as frame_{:04}.png, found '" + output + "'");
        if (!film_format_) {
            const auto format = options_.picture_format();
            if (!format) return tl::unexpected(format.error());
            format_ = *format;
        }
        for (const std::int64_t number : {whole_.first, whole_.last}) {
            const auto name = film_format_ ? Result<std::string>(output) : frame_name(output, options_.scene, options_.film, number);
            if (!name) return tl::unexpected(name.error());
            if (is_folder(*name)) return fail(ErrorCode::io, *name + ": " + platform::errno_text(EISDIR));
        }
        return {};
    }

    /// The file of a frame: the same for all in one file.
    [[nodiscard]] std::string file_of(std::size_t i) const {
        return film_format_ ? options_.output : frame_name(options_.output, options_.scene, options_.film, range_.number(i)).value_or("");
    }

    /// `each`: a check of one output.
    template <class Check>
    Result<void> for_each_file(Check each) {
        PictureOptions one = options_;
        for (std::size_t i = 0; i < (film_format_ ? 1 : range_.count()); ++i) {
            one.output = file_of(i);
            if (const auto checked = each(one); !checked) {
                options_.report = one.report;
                return checked;
            }
        }
        return {};
    }

    Result<void> check_paths_of_all() {
        const auto checked = for_each_file([](PictureOptions& one) { return check_paths(one); });
        if (!checked) return checked;
        const std::string folder = io::folder_of(file_of(0));
        if (!folder.empty() && !is_folder(folder))
            if (const auto made = make_folder(folder); !made) return tl::unexpected(made.error());
        if (!options_.report.empty())
            if (const auto writable = check_writable(options_.report); !writable) return writable;
        PictureOptions first = options_;
        first.output = file_of(0);
        for (const std::string& path : first.pictures())
            if (const auto writable = check_writable(path); !writable) return writable;
        return {};
    }

    Result<void> spare_inputs_of_all() {
        return for_each_file([this](PictureOptions& one) { return spare_inputs(one, *job_); });
    }

    Result<void> make_writer() {
        const bool floats = !film_format_ && is_linear(format_);
        for (Image& picture : pictures_) picture = make_image(*job_, floats);
        for (std::size_t i = 0; i < pictures_.size(); ++i) planes_.emplace_back(options_.aovs, *job_);
        if (!film_format_) return {};
        if (*film_format_ == film::FilmFormat::gif && !is_opaque()) job_->settings.contact_shadow = 0.0f;  // pixels are opaque or not there
        auto writer = film::make_film_writer(*film_format_, {pictures_[0].width, pictures_[0].height, range_.count(),
                                                             options_.film.frame_time(), is_opaque(), options_.film.dither});
        if (!writer) return fail(writer.error().code, options_.output + ": " + writer.error().message);
        writer_ = std::move(*writer);
        return {};
    }

    [[nodiscard]] bool is_opaque() const { return job_->settings.background_environment || job_->settings.background_linear.w >= 1.0f; }

    [[nodiscard]] PictureFile file_at(std::size_t i) const {
        PictureFile file;
        file.output = file_of(i);
        file.frame = FilmFrame{range_.number(i), whole_, options_.film.frame_time(), is_opaque()};
        file.shard = options_.shard;
        return file;
    }

    /// Brings the scene and the camera to a frame.
    Result<void> move_to(std::int64_t number, Camera& camera) {
        const FilmOptions& film = options_.film;
        SceneChanges changes;
        if (film.animates() && job_->source.motion && job_->animation() != nullptr) {
            job_->pose_time_s = film.time_s(number);
            auto posed = pose_job(*job_, job_->pose_time_s);
            if (!posed) return tl::unexpected(posed.error());
            changes = std::move(*posed);
            const int of_file = job_->film.file_camera;
            if (of_file >= 0) camera = job_->scene().cameras[static_cast<std::size_t>(of_file)];
        }
        if (film.several_views()) {
            camera = job_->film.views[static_cast<std::size_t>(number)];
            (void)relight(*job_, camera);
        }
        if (film.turntable > 0) {
            camera = turned_camera(camera, job_->film.bounds, number, film.turntable);
            (void)relight(*job_, camera);
        }
        const bool still = changes.changed_instances.empty() && changes.deformed_meshes.empty() && !changes.materials && !changes.lights;
        if (still) return {};
        return job_->prepared->update(changes, job_->timed_execution());
    }

    /// Frames of one turn, or of the whole animation, of which --frames may be a part.
    [[nodiscard]] std::int64_t frames_of_all() const {
        const FilmOptions& film = options_.film;
        if (film.turntable > 0) return film.turntable;
        if (film.several_views()) return static_cast<std::int64_t>(film.views.size());
        const AnimationInfo* const animation = job_->animation();
        if (animation == nullptr || !film.animates()) return 1;
        constexpr double kMost = 1e6;
        return static_cast<std::int64_t>(std::clamp(animation->end_s / film.time_s(1), 1.0, kMost));
    }

    /// Measures once what quality the film needs, by three of its frames, whichever are drawn. Each frame then depends on its number alone.
    /// A short film keeps full quality: probes take the time of one frame (a wide budget, which saves a fifth) to two and a half (a narrow
    /// one, which saves up to a twentieth).
    Result<void> measure() {
        if (!options_.film.quality || is_measured_) return {};
        is_measured_ = true;
        if (job_->prepared->triangle_count() == 0) {
            options_.film.quality.reset();
            print_note("quality: full, as all settings that it chooses are of surfaces; --max-error leaves faint Gaussians out");
            return {};
        }
        constexpr std::int64_t kFrames = 3;
        const std::int64_t all = frames_of_all();
        const std::int64_t least = options_.film.quality->codes >= raster::kWideBudget ? 16 : 128;
        if (all < least) {
            options_.film.quality.reset();
            print_note(fmt::format("quality: full, as a turn or an animation of fewer than {} frames does not repay measuring", least));
            return {};
        }
        for (std::int64_t k = 0; k < std::min(all, kFrames); ++k) {
            Camera camera = job_->camera;
            if (const auto moved = move_to(k * all / kFrames, camera); !moved) return moved;
            const auto one = Renderer::measure(*job_->prepared, job_->light, camera, job_->settings, *options_.film.quality, job_->width,
                                               job_->height, k == 0 ? nullptr : &measured_, job_->timed_execution());
            if (!one) return fail(one.error().code, fmt::format("{}: {}", job_->source.name, one.error().message));
            measured_ = *one;
        }
        job_->settings = with_share(job_->settings, measured_);
        const std::string size = measured_.shadow_size == 0 ? "auto" : std::to_string(measured_.shadow_size);
        print_note(fmt::format(
            "quality: {:.2f} % of the pixels within {} codes, by {} probes: {}", measured_.percent, measured_.asked.codes, measured_.probes,
            measured_.percent == 100.0
                ? "full quality"
                : fmt::format("--samples {} --anisotropy {} --shadow-size {}", measured_.samples, measured_.anisotropy, size)));
        return {};
    }

    /// A model that leaves the ground, as in a jump, leaves its contact shadow behind: 0 from a twentieth of the film's height on.
    [[nodiscard]] float standing_share() const {
        constexpr float kMost = 0.05f;
        const Bounds &all = job_->film.bounds, &now = job_->prepared->bounds();
        const float above = now.min.y - all.min.y, most = kMost * (all.max.y - all.min.y);
        return most > 0.0f ? std::clamp(1.0f - above / most, 0.0f, 1.0f) : 1.0f;
    }

    Result<Drawn> draw(std::size_t i) {
        if (const auto measured = measure(); !measured) return tl::unexpected(measured.error());
        const Stopwatch preparing;
        const std::int64_t number = range_.number(i);
        Camera camera = job_->camera;
        if (const auto moved = move_to(number, camera); !moved) return tl::unexpected(moved.error());
        Drawn drawn;
        const bool first = drawn_count_++ == 0;
        drawn.prepare_ms = preparing.ms() + (first ? job_->prepare_ms : 0.0);
        drawn.load_ms = first ? job_->load_ms : 0.0;
        drawn.pose_time_s = job_->pose_time_s;
        drawn.camera = camera;
        drawn.file = file_at(i);
        drawn.picture = &pictures_[drawn_count_ % pictures_.size()];
        drawn.planes = &planes_[drawn_count_ % pictures_.size()];
        Target target = target_of(*job_, *drawn.picture);
        drawn.planes->add_to(target);
        Settings settings = job_->settings;
        if (options_.film.animates()) settings.contact_shadow *= standing_share();
        const auto rendered = renderer_.render(*job_->prepared, job_->light, camera, settings, target, job_->timed_execution());
        if (!rendered)
            return fail(rendered.error().code, fmt::format("{}: frame {}: {}", job_->source.name, number, rendered.error().message));
        drawn.rendered = *rendered;
        if (const auto derived = drawn.planes->derive(*job_, camera); !derived) return tl::unexpected(derived.error());
        if (options_.film.quality) drawn.file.measured = measured_;
        return drawn;
    }

    /// On another thread than the drawing.
    Result<Encoded> encode(const Drawn& drawn) {
        try {
            const Stopwatch encoding;
            if (writer_) {
                if (const auto added = writer_->add(*drawn.picture); !added) return tl::unexpected(added.error());
                return Encoded{.ms = encoding.ms()};
            }
            const auto bytes = encode_image(*drawn.picture, format_);
            if (!bytes) return tl::unexpected(bytes.error());
            auto beside = drawn.planes->encode(drawn.file.output);
            if (!beside) return tl::unexpected(beside.error());
            const double ms = encoding.ms();
            if (const auto written = write_with_aovs(drawn.file.output, *bytes, *beside); !written) return tl::unexpected(written.error());
            for (AovFile& file : beside->files) file.bytes.clear();
            return Encoded{ms, pixel_hash(*bytes), std::move(*beside)};
        } catch (const std::bad_alloc&) {
            return fail(ErrorCode::limit, "out of memory while encoding a frame");
        }
    }

    /// Waits for the frame that is being encoded, and reports it.
    Result<void> settle(Drawn& drawn, std::future<Result<Encoded>>& encoding) {
        if (!encoding.valid()) return {};
        auto encoded = encoding.get();
        if (!encoded) return tl::unexpected(encoded.error());
        if (options_.report.empty()) return {};
        drawn.file.file_hash = encoded->file_hash;
        drawn.file.beside = std::move(encoded->beside);
        Camera camera = drawn.camera;
        const auto now = std::array{job_->load_ms, job_->prepare_ms, job_->pose_time_s};
        job_->load_ms = drawn.load_ms, job_->prepare_ms = drawn.prepare_ms, job_->pose_time_s = drawn.pose_time_s;
        std::swap(job_->camera, camera);
        report_ += picture_report(drawn.file, *job_, drawn.rendered, *drawn.picture, encoded->ms, true);
        std::swap(job_->camera, camera);
        job_->load_ms = now[0], job_->prepare_ms = now[1], job_->pose_time_s = now[2];
        return {};
    }

    Result<void> draw_all() {
        ProgressLine line(false, 500.0);
        Drawn before;
        std::future<Result<Encoded>> encoding;  // waits for its thread where it is destroyed, so before what that reads
        for (std::size_t i = 0; i < range_.count(); ++i) {
            if (skip_existing_ && is_there(file_of(i))) {
                if (const auto settled = settle(before, encoding); !settled) return settled;
                report_ += skipped_report(job_->source.name, file_at(i));
                continue;
            }
            auto next = draw(i);
            if (const auto settled = settle(before, encoding); !settled) return settled;
            if (!next) return tl::unexpected(next.error());
            if (drawn_count_ == 1)
                for (const std::string& warning : next->rendered.warnings) print_warning(warning);
            before = std::move(*next);
            const auto encode_it = [this, &before] { return encode(before); };
            try {
                encoding = std::async(std::launch::async, encode_it);
            } catch (const std::system_error&) {
                encoding = std::async(std::launch::deferred, encode_it);  // no thread can be started: this one does it
            }
            line.show(i + 1, range_.count());
        }
        return settle(before, encoding);
    }

    Result<void> finish() {
        if (!writer_) {
            if (drawn_count_ == 0) {
                if (range_.count() > 0) print_note(fmt::format("nothing to do: all {} frames are there", range_.count()));
                return {};
            }
            print_note(range_.count() == 1
                           ? "wrote " + file_of(0)
                           : fmt::format("wrote {} frames, {} to {}{}", drawn_count_, file_of(0), file_of(range_.count() - 1), hint_));
            return {};
        }
        const auto bytes = writer_->finish();
        if (!bytes) return tl::unexpected(bytes.error());
        if (const auto written = io::write_file(options_.output, *bytes); !written) return tl::unexpected(written.error());
        print_note(fmt::format("wrote {}: {} frames, {} bytes", options_.output, range_.count(), bytes->size()));
        return {};
    }

    PictureOptions& options_;
    bool skip_existing_;
    std::string_view hint_;        ///< for a film that nobody named
    FrameRange whole_, range_;     ///< all frames, and those of this shard
    std::size_t drawn_count_ = 0;  ///< frames that were drawn
    RenderJob* job_ = nullptr;
    std::optional<film::FilmFormat> film_format_;
    OutputFormat format_ = OutputFormat::png;
    std::unique_ptr<film::FilmWriter> writer_;
    std::array<Image, 2> pictures_;  ///< one is drawn while the other is encoded
    std::vector<AovPlanes> planes_;  ///< of each of them
    Renderer renderer_;
    bool is_measured_ = false;
    MeasuredShare measured_;  ///< of the film
    std::string report_;
};

/// --share and --max-error become a quality.
Result<void> settle_quality(PictureOptions& options) {
    FilmOptions& film = options.film;
    double& codes = options.settings.shading.max_error_codes;
    if (film.share) {
        if (film.quality) return fail(ErrorCode::usage, "--share: cannot be combined with --quality");
        if (!(codes > 0.0)) return fail(ErrorCode::usage, kShareNeeds);
        film.quality = ShareBudget{codes, *film.share};
        codes = 0.0;
    }
    if (!film.quality) return {};
    if (codes > 0.0)
        return fail(ErrorCode::usage, "--quality: cannot be combined with --max-error; --max-error E --share P is a quality of its own");
    if (options.settings.shading.accuracy != Accuracy::exact)
        return fail(ErrorCode::usage, "--quality: cannot be combined with --accuracy reference");
    return {};
}

}  // namespace

Result<int> render_film(PictureOptions options, bool skip_existing) {
    if (const auto checked = check_film_options(options.film, options.output); !checked) return tl::unexpected(checked.error());
    if (options.blank_check) return fail(ErrorCode::usage, "--blank-check: cannot be combined with --frames, --turntable or several views");
    if (const auto settled = settle_quality(options); !settled) return tl::unexpected(settled.error());
    io::begin_file_set();
    if (const auto checked = check_report(options.report); !checked) return tl::unexpected(checked.error());
    if (!options.report.empty())
        set_last_words([path = options.report, scene = options.scene](int signal) {
            (void)write_text(path, error_report(scene, 128 + signal, "interrupted by signal " + std::to_string(signal), true));
        });
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    FilmRun film(options, skip_existing);
    const Result<void> done = within_memory(options, [&] { return film.run(); });
    const bool may_report = !options.report.empty() && (done || done.error().code != ErrorCode::usage);
    if (may_report) {
        const std::string failure =
            done ? "" : error_report(options.scene, static_cast<int>(done.error().code), done.error().message, true);
        const Result<void> written = write_text(options.report, film.report() + failure);
        if (!written && done) return tl::unexpected(written.error());
    }
    if (!done) return tl::unexpected(done.error());
    return 0;
}

}  // namespace halflit::cli
