#include "arris/render_job.h"

#include <algorithm>
#include <chrono>

#include "arris/error.h"
#include "arris/io.h"

namespace arris::program {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

PictureSum load_checkpoint(const RenderJob& job) {
  const std::string name = job.checkpoint->string();
  const PictureFile file = load_picture_file(*job.checkpoint);
  const RenderPart part = render_part_of(file, name);
  const std::uint64_t samples = sample_count(part);
  const bool fits = part.scene == job.part.scene && part.seed == job.part.seed &&
                    part.integrator == job.part.integrator && part.samples.size() == 1 &&
                    part.samples[0].first == job.options.samples.first &&
                    part.samples[0].last <= job.options.samples.last;
  if (!fits) {
    throw Error(
        Error::Kind::input, name,
        "is the checkpoint of another render (scene, size, seed, layers or samples differ); "
        "delete it or name another file");
  }
  try {
    PictureSum sum = unpack_sum(file.picture, samples);
    bool same_layers = sum.images.size() == job.options.aovs.size() + 1;
    for (const std::string& aov : job.options.aovs) {
      same_layers = same_layers && std::any_of(sum.images.begin(), sum.images.end(),
                                               [&](const ImageSum& i) { return i.name == aov; });
    }
    if (!same_layers) throw Error(Error::Kind::input, "", "has other layers than --aov asks for");
    return sum;
  } catch (const Error& error) {
    throw Error(Error::Kind::input, name,
                std::string(error.what()) + "; delete it or name another file");
  }
}

class Job {
 public:
  Job(const Renderer& renderer, const PreparedScene& scene, const RenderJob& job)
      : renderer_(renderer), scene_(scene), job_(job) {}

  JobResult run() {
    const SampleRange wanted = job_.options.samples;
    if (job_.checkpoint && std::filesystem::exists(*job_.checkpoint)) {
      sum_ = load_checkpoint(job_);
    }
    JobResult result;
    result.resumed = sum_.samples;
    start_ = position_ = wanted.first + std::uint32_t(sum_.samples);
    // A resumed render that is complete, or stopped at once, has a picture already.
    while (position_ < wanted.last && (sum_.samples == 0 || !must_end())) {
      if (!render_chunk(result)) break;
      save_checkpoint_if_due();
    }
    if (job_.checkpoint && unsaved_) save_checkpoint();
    if (sum_.samples == 0) {
      throw Error(Error::Kind::failed, "", "stopped before the first sample");
    }
    result.part = job_.part;
    result.part.samples = {{wanted.first, wanted.first + std::uint32_t(sum_.samples)}};
    result.complete = result.part.samples[0].last == wanted.last;
    result.sum = std::move(sum_);
    result.seconds = seconds_since(begin_);
    return result;
  }

 private:
  [[nodiscard]] bool must_end() const {
    const RenderOptions& options = job_.options;
    const bool late =
        options.time_limit_seconds > 0 && seconds_since(begin_) >= options.time_limit_seconds;
    return late || (options.stop != nullptr && options.stop->load());
  }

  // False if the chunk could not be completed.
  bool render_chunk(JobResult& result) {
    RenderOptions options = job_.options;
    options.samples = {position_, std::min(options.samples.last, position_ + job_.chunk_samples)};
    options.least_samples = sum_.samples == 0 ? 1 : 0;
    if (options.time_limit_seconds > 0) {
      constexpr double kLeast = 1e-3;  // 0 means no limit
      options.time_limit_seconds =
          std::max(options.time_limit_seconds - seconds_since(begin_), kLeast);
    }
    options.on_progress = [&](const Progress& chunk) {
      report_progress(chunk.done * (options.samples.last - options.samples.first));
    };
    const RenderResult chunk = renderer_.render(scene_, options);
    result.rays.camera += chunk.rays.camera;
    result.rays.total += chunk.rays.total;
    result.rays.rounded += chunk.rays.rounded;
    result.beam = chunk.beam;
    const std::uint32_t samples = chunk.samples.last - chunk.samples.first;
    add_sum(sum_, *chunk.sum);
    position_ += samples;
    unsaved_ = true;
    report_progress(0);
    return chunk.samples.last == options.samples.last;
  }

  void report_progress(double samples_of_chunk) const {
    if (!job_.options.on_progress) return;
    const double elapsed = seconds_since(begin_);
    double done = (position_ - start_ + samples_of_chunk) / (job_.options.samples.last - start_);
    if (job_.options.time_limit_seconds > 0) {
      done = std::max(done, elapsed / job_.options.time_limit_seconds);
    }
    job_.options.on_progress({std::min(done, 1.0), elapsed});
  }

  void save_checkpoint_if_due() {
    if (!job_.checkpoint || seconds_since(saved_) < kCheckpointSeconds) return;
    save_checkpoint();
  }

  void save_checkpoint() {
    RenderPart part = job_.part;
    part.samples = {{job_.options.samples.first, position_}};
    SaveOptions options;
    options.attributes = attributes_of(part);
    save_picture(pack_sum(sum_), *job_.checkpoint, options);
    saved_ = Clock::now();
    unsaved_ = false;
  }

  const Renderer& renderer_;
  const PreparedScene& scene_;
  const RenderJob& job_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point saved_ = begin_;
  bool unsaved_ = false;
  std::uint32_t start_ = 0, position_ = 0;
  PictureSum sum_;
};

}  // namespace

JobResult run_job(const Renderer& renderer, const PreparedScene& scene, const RenderJob& job) {
  return Job(renderer, scene, job).run();
}

}  // namespace arris::program
