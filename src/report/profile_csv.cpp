#include "report/csv.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"

#include <cstddef>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Writes a line for each figure of a run.
class ProfileCsv {
  public:
    explicit ProfileCsv(const ProfileReport& report) : report_(report) {
        for (const ProfileRun& run : report.runs) add(run);
    }

    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    void line(const ProfileRun& run, const char* part, const std::string& name, double value, const char* unit) {
        text_ += fmt::format("{},{},{},{},{},{},{},{},{}\n", csv_field(report_.scene), csv_field(report_.created),
                             csv_field(run.integrator), run.threads, run.spp, part, csv_field(name), csv_number(value),
                             unit);
    }

    void lines(const ProfileRun& run, const char* part, const std::vector<NamedValue>& values, const char* unit) {
        for (const NamedValue& value : values) line(run, part, value.name, value.value, unit);
    }

    void lines(const ProfileRun& run, const char* part, const std::vector<HitsReport>& met) {
        for (const HitsReport& one : met) {
            line(run, part, one.name, one.hits, "hits");
            line(run, part, one.name, one.seconds, "thread s");
        }
    }

    void add(const ProfileRun& run) {
        for (std::size_t i = 0; i < run.seconds.size(); ++i) {
            line(run, "repetition", fmt::format("{}", i + 1), run.seconds[i], "s");
            line(run, "repetition", fmt::format("{}", i + 1), run.cpu_seconds[i], "CPU s");
        }
        line(run, "run", "samples", static_cast<double>(run.samples), "");
        line(run, "run", "samples per second", samples_per_second(run), "1/s");
        line(run, "run", "rays per second", rays_per_second(run), "1/s");
        line(run, "run", "efficiency single", run.efficiency_single, "");
        line(run, "run", "efficiency best", run.efficiency_best, "");
        line(run, "run", "parallel efficiency", run.parallel_efficiency, "");
        line(run, "run", "imbalance", run.load_imbalance, "");
        line(run, "run", "tracing share", tracing_share(run), "");
        for (const RayKindReport& kind : run.kinds) {
            line(run, "rays", kind.kind, static_cast<double>(kind.rays), "rays");
            line(run, "rays", kind.kind, kind.seconds, "thread s");
            line(run, "hit share", kind.kind, kind.hit_share, "");
            line(run, "packet fill", kind.kind, kind.packet_fill, "");
        }
        lines(run, "stage", run.stages, "thread s");
        lines(run, "ending", run.eye_paths.endings, "paths");
        lines(run, "light ending", run.light_paths.endings, "paths");
        lines(run, "material", run.scene_hits.materials);
        lines(run, "object", run.scene_hits.objects);
        lines(run, "texture", run.scene_hits.textures);
        for (const LampReport& lamp : run.scene_hits.lamps) {
            line(run, "lamp", lamp.name, lamp.shadow_rays, "shadow rays");
            line(run, "lamp", lamp.name, lamp.blocked, "blocked");
            line(run, "lamp", lamp.name, lamp.seconds, "thread s");
        }
    }

    const ProfileReport& report_;
    std::string text_ = "scene,created,integrator,threads,spp,part,name,value,unit\n";
};

}  // namespace

std::string to_csv(const ProfileReport& report) {
    return ProfileCsv(report).text();
}

}  // namespace etendue
