// Roll filtered as an angle, as paper 000 prints it, against axes filtered first and the angle taken from their
// estimates, on the shipped tilt streams: in the open, near a pitch of 90 degrees and across a roll of 180.
#include "estimators.hpp"
#include "experiments_000.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace papers::roll
{
namespace
{
const double degree = std::acos(-1.0) / 180.0;
const double lsb_per_degree = 256.0 *
                              degree;    // near level, 256 LSB/g: so that a filter's q and R mean the same for both
constexpr double y_to_z = 256.0 / 265.0; // the streams' sensitivities, LSB/g
constexpr double noise_lsb = 2.0;        // of the streams' x and y at 100 Hz; z has 1.3 times that
constexpr double z_ratio = 1.3;

struct Sample {
    double y_lsb;
    double z_lsb;
    double roll_deg; // truth
    double pitch_deg;
};

struct Stream {
    double rate_hz;
    std::vector<Sample> samples;
};

std::vector<std::string> cells_of(const std::string &line)
{
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) {
        cells.push_back(cell);
    }
    return cells;
}

Stream read(const std::string &name)
{
    const std::string path = "sim/streams/" + name + ".csv";
    std::ifstream file(path);
    if (!file) {
        throw std::runtime_error(path + ": cannot be read (run from the repository's root)");
    }
    Stream stream{};
    std::vector<double> times_us;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
        number++;
        if (line.empty() || line[0] == '#' || line[0] == 't') {
            continue;
        }
        const std::vector<std::string> cells = cells_of(line);
        if (cells.size() != 6) {
            throw std::runtime_error(path + ":" + std::to_string(number) + ": wanted six fields, with the true angles");
        }
        times_us.push_back(std::stod(cells[0]));
        stream.samples.push_back({ y_to_z * std::stod(cells[2]), std::stod(cells[3]), 0.01 * std::stod(cells[4]),
                                   0.01 * std::stod(cells[5]) });
    }
    if (times_us.size() < 2) {
        throw std::runtime_error(path + ": no samples");
    }
    stream.rate_hz = std::round(1e6 * static_cast<double>(times_us.size() - 1) / (times_us.back() - times_us.front()));
    return stream;
}

double wrapped(double angle_deg)
{
    return std::remainder(angle_deg, 360.0);
}

double roll_of(double y, double z)
{
    return std::atan2(y, z) / degree;
}

enum Way { angle, angle_unwrapped, axes, way_count };
constexpr std::array<const char *, way_count> way_names{ "angle", "angle_unwrapped", "axes" };

// The roll by each way, sample by sample.
using Track = std::vector<double>;

Track track_of(const Stream &stream, Way way, const std::array<Maker, 3> &makers)
{
    const Estimator of_angle = makers[0]();
    const Estimator of_y = makers[1]();
    const Estimator of_z = makers[2]();
    Track track;
    double unwrapped = roll_of(stream.samples.front().y_lsb, stream.samples.front().z_lsb);
    for (const Sample &s : stream.samples) {
        const double raw = roll_of(s.y_lsb, s.z_lsb);
        if (way == axes) {
            track.push_back(roll_of(of_y(s.y_lsb), of_z(s.z_lsb)));
        } else {
            unwrapped += wrapped(raw - unwrapped);
            track.push_back(wrapped(of_angle(way == angle ? raw : unwrapped)));
        }
    }
    return track;
}

struct Region {
    const char *name;
    bool (*holds)(const Sample &s);
};

// At more than 89 degrees of pitch y and z together are below 4.5 LSB: there is no roll.
const std::array<Region, 4> regions{ {
    { "open", [](const Sample &s) { return std::fabs(s.pitch_deg) < 60.0 && std::fabs(s.roll_deg) < 150.0; } },
    { "near_90", [](const Sample &s) { return std::fabs(s.pitch_deg) >= 75.0 && std::fabs(s.pitch_deg) <= 89.0; } },
    { "near_180", [](const Sample &s) { return std::fabs(s.roll_deg) > 170.0 && std::fabs(s.pitch_deg) < 60.0; } },
    { "all", [](const Sample &s) { return std::fabs(s.pitch_deg) <= 89.0; } },
} };

// Root mean square of the wrapped difference in a region, without the first second; NaN when the stream is never there.
double rmse(const Stream &stream, const Track &track, const Region &region)
{
    double sum = 0.0;
    double count = 0.0;
    for (auto k = static_cast<std::size_t>(stream.rate_hz); k < track.size(); k++) {
        if (region.holds(stream.samples[k])) {
            const double error = wrapped(track[k] - stream.samples[k].roll_deg);
            sum += error * error;
            count += 1.0;
        }
    }
    return count < 20.0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / count);
}

void rows(const std::string &stream_name, const Stream &stream, const std::string &name, Arithmetic arithmetic,
          const std::array<Maker, 3> &makers)
{
    for (int way = 0; way < way_count; way++) {
        const Track track = track_of(stream, static_cast<Way>(way), makers);
        for (const Region &region : regions) {
            const double value = rmse(stream, track, region);
            if (std::isfinite(value)) {
                row("roll_" + stream_name, name, arithmetic,
                    std::string("rmse_") + region.name + "_" + way_names[static_cast<std::size_t>(way)], value, 1);
            }
        }
    }
}

std::array<Maker, 3> shipped_for(const std::string &name, double rate_hz)
{
    Shipping shipping;
    shipping.rate_hz = rate_hz;
    shipping.lsb_per_unit = 1.0;
    shipping.r = noise_lsb * noise_lsb * rate_hz / 100.0;
    const Maker y = shipped(name, shipping);
    shipping.r *= z_ratio * z_ratio;
    const Maker z = shipped(name, shipping);
    shipping.r = noise_lsb * noise_lsb * rate_hz / 100.0 / (lsb_per_degree * lsb_per_degree);
    shipping.lsb_per_unit = lsb_per_degree;
    return { shipped(name, shipping), y, z };
}
} // namespace

void roll_as_angle(const Options &)
{
    const std::array<const char *, 5> names{ "tilt-slow", "tilt-fast", "tilt-400hz", "through-pitch-90",
                                             "through-roll-180" };
    Progress progress(static_cast<double>(names.size()));
    const Maker none = [] { return [](double z) { return z; }; };
    for (const char *name : names) {
        const Stream stream = read(name);
        rows(name, stream, "unfiltered", Arithmetic::in_double, { none, none, none });
        const Maker synth = synthesised(0.0, 0.3);
        rows(name, stream, "synth(0:0.3)", Arithmetic::in_double, { synth, synth, synth });
        const Maker paper = synthesised(-0.3, 0.1);
        rows(name, stream, "synth(-0.3:0.1)", Arithmetic::in_double, { paper, paper, paper });
        for (const std::string &filter : shipped_names()) {
            rows(name, stream, filter, Arithmetic::fixed, shipped_for(filter, stream.rate_hz));
        }
        progress.advance();
    }
}
} // namespace papers::roll
