// flight_series STATES DRIFT WALK_SCALE SEED...: errors of paper 003's flight in closed loop, a flight for each seed.
//
// STATES: 9 or 12; DRIFT: none, gyro or both; WALK_SCALE: on the printed q. The field at 1 Hz, nav/lib in float with
// its queue. For each second a line: seed, second, true less computed roll, pitch, heading (rad), velocity (m/s),
// position (m), drift (rad/s), then the standard deviations that the filter states for position, velocity and attitude.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

extern "C" {
#include "nav_flights.h"
}

namespace
{
void print(const char *seed, int second, const nav_second_t &at)
{
    std::printf("%s,%d", seed, second);
    for (const double *values : { at.euler, at.velocity, at.position, at.drift }) {
        std::printf(",%.7g,%.7g,%.7g", values[0], values[1], values[2]);
    }
    for (int i = 0; i < 9; i++) {
        std::printf(",%.7g", std::sqrt(at.variance[i]));
    }
    std::printf("\n");
}

const flight_drift_t *drift_of(const char *word)
{
    if (std::strcmp(word, "none") == 0) {
        return &flight_no_drift;
    }
    return std::strcmp(word, "gyro") == 0 ? &flight_gyro_drift : &flight_both_drifts;
}
} // namespace

int main(int argc, char **argv)
{
    if (argc < 5) {
        std::fprintf(stderr, "flight_series STATES DRIFT WALK_SCALE SEED...\n");
        return 2;
    }
    nav_plan_t plan{};
    plan.variant = std::atoi(argv[1]) == 9 ? &n9f : &n12f;
    plan.drift = drift_of(argv[2]);
    plan.walk_scale = std::atof(argv[3]);
    plan.field_every = FLIGHT_RATE;
    plan.note_at = FLIGHT_RATE - 1;
    plan.seconds = FLIGHT_SECONDS;
    const auto flight = std::make_unique<nav_flight_t>();
    for (int i = 4; i < argc; i++) {
        plan.seed = static_cast<std::uint32_t>(std::stoul(argv[i]));
        nav_fly(flight.get(), &plan);
        for (int second = 0; second < FLIGHT_SECONDS; second++) {
            print(argv[i], second + 1, flight->second[second]);
        }
    }
    return 0;
}
