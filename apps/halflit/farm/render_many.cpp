#include "apps/halflit/farm/render_many.hpp"
#include "apps/halflit/farm/picture_report.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/progress_line.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/files/model_files.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/process.hpp"
#include "sh/available_cores.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

namespace halflit::cli {
namespace {

using platform::FileId, platform::whole_path;

std::optional<FileId> file_id(const std::string& path) {
    platform::FileStatus status;
    return platform::status_of(path, status) == 0 ? std::optional(status.id) : std::nullopt;
}

std::uintmax_t bytes_of(const std::string& path) {
    platform::FileStatus status;
    return platform::status_of(path, status) == 0 ? status.bytes : 0;
}

/// Leaves to draw, for a number of threads. They are given in the order in which they were asked for, so a scene that needs all threads
/// waits no longer than those before it take.
class Permits {
public:
    explicit Permits(int count) : free_(count) {}
    void take(int count) {
        std::unique_lock lock(mutex_);
        const std::uint64_t ticket = tickets_++;
        changed_.wait(lock, [&] { return ticket == served_ && free_ >= count; });
        free_ -= count;
        ++served_;
        changed_.notify_all();
    }
    void give_back(int count) {
        const std::scoped_lock lock(mutex_);
        free_ += count;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int free_;
    std::uint64_t tickets_ = 0, served_ = 0;
};

/// Messages and result of one scene.
struct Outcome {
    std::string messages, report;
    int code = 0;
    bool blank = false, skipped = false;
};

class Batch {
public:
    explicit Batch(const ManyOptions& options)
        : options_(options), threads_(thread_count(options)), permits_(threads_), outcomes_(options.scenes.size()) {
        if (const auto& shard = options.each.shard) {
            next_ = told_ = static_cast<std::size_t>(shard->index);
            step_ = static_cast<std::size_t>(shard->count);
        }
    }

    Result<int> run() {
        if (const auto named = name_pictures(); !named) return tl::unexpected(named.error());
        if (const auto checked = spare_inputs(); !checked) return tl::unexpected(checked.error());
        std::set<std::string> folders;
        for (const PictureOptions& picture : pictures_) folders.insert(io::folder_of(picture.output));
        for (const std::string& folder : folders)
            if (const auto made = make_folder(folder); !made) return tl::unexpected(made.error());
        if (const auto opened = open_report(); !opened) return tl::unexpected(opened.error());
        if (options_.each.max_memory_bytes == 0) platform::prepare_heap();
        // Beyond those that draw, some wait until the system has their file on its disk.
        constexpr std::size_t kWriters = 8;
        const std::size_t wanted = std::min((pictures_.size() + step_ - 1) / step_, static_cast<std::size_t>(threads_) + kWriters);
        std::vector<std::thread> others;
        try {
            while (others.size() + 1 < wanted) others.emplace_back([this] { work(); });
        } catch (const std::system_error&) {
            // Fewer threads do it too.
        }
        work();
        for (std::thread& thread : others) thread.join();
        if (report_ != nullptr && std::fclose(report_.release()) != 0 && !report_error_) report_error_ = errno;
        if (report_error_) return fail(ErrorCode::io, options_.each.report + ": " + platform::errno_text(*report_error_));
        progress_.clear();
        if (is_long() && written_ > 0)
            print_note(fmt::format("wrote {} pictures, {} to {}{}", written_, first_, last_,
                                   failed_ > 0 ? fmt::format("; {} could not be drawn, see above", failed_) : ""));
        if (skipped_ > 0 && written_ + failed_ == 0) print_note(fmt::format("nothing to do: all {} pictures are there", skipped_));
        return code_ != 0 ? code_ : any_blank_ ? 1 : 0;
    }

private:
    static int thread_count(const ManyOptions& options) {
        const int wanted = options.each.execution.threads;
        return wanted > 0 ? wanted : available_cores();
    }

    Result<void> name_pictures() {
        std::map<std::string, const std::string*> scene_of;
        for (std::size_t i = 0; i < options_.scenes.size(); ++i) {
            const std::string& scene = options_.scenes[i];
            PictureOptions& one = pictures_.emplace_back(options_.each);
            one.scene = scene;
            one.report.clear();
            one.place = ScenePlace{i, options_.scenes.size()};
            one.one_of_many = options_.scenes.size() > 1;
            auto name = picture_name(options_.each.output, options_.each.format, scene, i);
            if (!name) return tl::unexpected(name.error());
            one.output = std::move(*name);
            for (std::string& path : one.pictures()) {
                if (path == options_.each.report)
                    return fail(ErrorCode::usage, "--report: expected another file than the picture's, found '" + path + "'");
                if (const auto [other, is_new] = scene_of.try_emplace(std::move(path), &scene); !is_new)
                    return fail(ErrorCode::usage, fmt::format("{}: {} has the same picture {} ({{index}} in -o tells them apart)", scene,
                                                              *other->second == scene ? "another scene" : *other->second, other->first));
            }
        }
        return {};
    }

    /// Refuses pictures that would overwrite a scene, or a file which one of the scenes refers to, there or not. Counts the scenes' bytes.
    /// A scene whose files are not known within its time is not drawn.
    Result<void> spare_inputs() {
        std::map<FileId, std::string> there;           // pictures, and the report
        std::map<std::string, std::string> not_there;  // by their whole paths
        const auto add = [&](const std::string& path) {
            if (path.empty() || path == "-") return;
            if (const auto id = file_id(path))
                there.emplace(*id, path);
            else
                not_there.emplace(whole_path(path), path);
        };
        for (const PictureOptions& picture : pictures_)
            for (const std::string& path : picture.pictures()) add(path);
        add(options_.each.report);
        bytes_.resize(pictures_.size());
        for (std::size_t i = next_; i < pictures_.size(); i += step_) {  // other shards look at theirs
            const PictureOptions& picture = pictures_[i];
            std::uintmax_t& bytes = bytes_[i];
            if (!is_file(picture.scene)) continue;
            auto files = io::files_named_by(picture.scene, picture.timed_load());
            if (!files) {
                unread_.emplace(i, files.error());
                continue;
            }
            std::vector<std::string> inputs = *std::move(files);
            inputs.push_back(picture.scene);
            for (const std::string& input : inputs) {
                bytes += bytes_of(input);
                const std::string* target = nullptr;
                if (const auto id = file_id(input)) {
                    if (const auto found = there.find(*id); found != there.end()) target = &found->second;
                } else if (const auto found = not_there.find(whole_path(input)); found != not_there.end()) {
                    target = &found->second;
                }
                if (target == nullptr) continue;
                if (input == picture.scene) return fail(ErrorCode::io, *target + ": is the scene itself and is not overwritten");
                return fail(ErrorCode::io, *target + ": " + picture.scene + " refers to it, and it is not overwritten");
            }
        }
        return {};
    }

    Result<void> open_report() {
        const std::string& path = options_.each.report;
        if (path.empty()) return {};
        if (const auto checked = check_report(path); !checked) return checked;
        report_.reset(platform::open_for_lines(path));
        if (report_ == nullptr) return fail(ErrorCode::io, path + ": " + platform::errno_text(errno));
        return {};
    }

    void work() {
        for (;;) {
            std::size_t i = 0;
            {
                const std::scoped_lock lock(mutex_);
                if (next_ >= pictures_.size()) return;
                i = next_;
                next_ += step_;
            }
            Outcome outcome;
            {
                HeldMessages held;
                try {
                    outcome = draw(i);
                } catch (const std::bad_alloc&) {
                    outcome = failure(i, {ErrorCode::limit, pictures_[i].scene + ": out of memory"});
                }
                outcome.messages = held.take();
            }
            const std::scoped_lock lock(mutex_);
            outcomes_[i] = std::move(outcome);
            tell();
        }
    }

    Outcome failure(std::size_t i, const Error& error) {
        print_error(error.message);
        const int code = static_cast<int>(error.code);
        return {"", error_report(pictures_[i].scene, code, error.message, true), code};
    }

    Outcome draw(std::size_t i) {
        PictureOptions& options = pictures_[i];
        if (const auto unread = unread_.find(i); unread != unread_.end()) return failure(i, unread->second);
        if (options_.skip_existing && is_there(options.output)) {
            print_detail(options.output + " is there and was left alone");
            PictureFile there;
            there.output = options.output;
            there.shard = options.shard;
            there.place = options.place;
            return {"", skipped_report(options.scene, there), 0, false, true};
        }
        const int threads = is_large(i) ? threads_ : 1;
        options.execution.threads = threads;
        permits_.take(threads);
        Result<PictureFile> picture = fail(ErrorCode::internal, "");
        try {
            picture = draw_picture(options, true);
        } catch (...) {
            permits_.give_back(threads);
            throw;
        }
        permits_.give_back(threads);
        if (!picture) return failure(i, picture.error());
        if (const auto written = write_picture(*picture, is_long()); !written) return failure(i, written.error());
        return {"", std::move(picture->report), 0, picture->blank};
    }

    /// Large scenes and pictures are drawn one at a time: by all threads, and within the memory that one of them takes.
    [[nodiscard]] bool is_large(std::size_t i) const {
        constexpr std::uintmax_t kLargeFile = std::uintmax_t{8} << 20;
        constexpr std::int64_t kLargePicture = std::int64_t{4} << 20;  // samples
        const PictureOptions& options = pictures_[i];
        const PictureSize size = options.size.value_or(kRenderSize);
        return bytes_[i] > kLargeFile || std::int64_t{size.width} * size.height * options.settings.samples > kLargePicture;
    }

    /// Too many pictures for a line each.
    [[nodiscard]] bool is_long() const { return pictures_.size() > 20 * step_; }

    /// Tells the outcomes that are next in order.
    void tell() {
        for (; told_ < outcomes_.size() && outcomes_[told_]; told_ += step_) {
            Outcome& outcome = *outcomes_[told_];
            if (!outcome.messages.empty()) progress_.clear();
            std::fwrite(outcome.messages.data(), 1, outcome.messages.size(), stderr);
            if (report_ != nullptr && !report_error_ &&
                (std::fwrite(outcome.report.data(), 1, outcome.report.size(), report_.get()) != outcome.report.size() ||
                 std::fflush(report_.get()) != 0))
                report_error_ = errno;
            if (code_ == 0) code_ = outcome.code;
            any_blank_ |= outcome.blank;
            ++(outcome.skipped ? skipped_ : outcome.code != 0 ? failed_ : written_);
            if (outcome.code == 0 && !outcome.skipped) {
                if (written_ == 1) first_ = pictures_[told_].output;
                last_ = pictures_[told_].output;
            }
            outcome = {};
            if (is_long()) progress_.show(told_ / step_ + 1, (pictures_.size() + step_ - 1) / step_);
        }
    }

    struct CloseFile {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };

    const ManyOptions& options_;
    int threads_;
    Permits permits_;
    std::vector<PictureOptions> pictures_;
    std::vector<std::uintmax_t> bytes_;           ///< of each scene, with the files that it refers to
    std::map<std::size_t, Error> unread_;         ///< scenes whose files are not known
    std::mutex mutex_;                            ///< guards all below
    std::size_t next_ = 0, told_ = 0, step_ = 1;  ///< the shard's scenes are `step_` apart
    std::vector<std::optional<Outcome>> outcomes_;
    std::unique_ptr<std::FILE, CloseFile> report_;
    std::optional<int> report_error_;
    int code_ = 0;
    bool any_blank_ = false;
    std::size_t skipped_ = 0, written_ = 0, failed_ = 0;
    std::string first_, last_;  ///< of the pictures that were written
    ProgressLine progress_{false};
};

}  // namespace

Result<std::string> picture_name(const std::string& output, std::optional<OutputFormat> format, const std::string& scene,
                                 std::size_t index) {
    const std::string usual = default_output(scene, format);
    if (!is_pattern(output)) return output + usual;
    return fill_pattern(output, "{stem}, {folder}, {index} or {index:04}", [&](std::string_view word) -> std::optional<std::string> {
        if (word == "stem") return stem_of(usual);
        if (word == "folder") return io::folder_of(scene);
        return digits_for(word, "index", static_cast<std::int64_t>(index));
    });
}

Result<int> render_many(const ManyOptions& options) { return Batch(options).run(); }

}  // namespace halflit::cli
