/*
 * The whole firmware as a native program: a stream in, the UART's bytes out. Same options and meanings as simrun's, so
 * that a test can run both and compare them row by row; thousands of times faster than real time.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "hal_host.h"

enum { COMMANDS_MAX = 32, COMMAND_LENGTH = 80 };

typedef struct {
    double at_ms;
    char text[COMMAND_LENGTH];
} typed_t;

static struct {
    const char *in, *out, *served;
    double ppm, max_ms;
    uint32_t time_start_us;
    typed_t typed[COMMANDS_MAX];
    size_t typed_count;
    bool loop;
} options = { .max_ms = 1e9 };

static FILE *out_file;
static FILE *served_file;
static unsigned served_count;
static bool header_seen;
static stream_t stream;

static void usage(const char *problem)
{
    fprintf(stderr,
            "native_replay: %s\nusage: native_replay --in CSV --out CSV [--filter NAME] [--rate HZ] [--range G] "
            "[--every N]\n"
            "  [--baud N] [--cmd MS:TEXT]... [--served CSV] [--ppm N] [--max-ms N] [--loop] [--time-start US]\n",
            problem);
    exit(2);
}

static void add_command(double at_ms, const char *name, const char *value)
{
    if (options.typed_count == COMMANDS_MAX) {
        usage("too many commands");
    }
    typed_t *typed = &options.typed[options.typed_count++];
    typed->at_ms = at_ms;
    snprintf(typed->text, sizeof typed->text, "%s%s%s\n", name, *value ? " " : "", value);
}

static void add_timed_command(const char *argument)
{
    char *end;
    double at_ms = strtod(argument, &end);
    if (end == argument || *end != ':') {
        usage("--cmd wants MS:TEXT");
    }
    add_command(at_ms, end + 1, "");
}

static bool is_setting(const char *name)
{
    static const char *const settings_typed[] = { "filter", "rate", "range", "every", "baud" };
    for (size_t i = 0; i < sizeof settings_typed / sizeof settings_typed[0]; i++) {
        if (strcmp(name, settings_typed[i]) == 0) {
            return true;
        }
    }
    return false;
}

static void take_option(const char *name, const char *value)
{
    if (strcmp(name, "in") == 0) {
        options.in = value;
    } else if (strcmp(name, "out") == 0) {
        options.out = value;
    } else if (strcmp(name, "served") == 0) {
        options.served = value;
    } else if (strcmp(name, "ppm") == 0) {
        options.ppm = atof(value);
    } else if (strcmp(name, "max-ms") == 0) {
        options.max_ms = atof(value);
    } else if (strcmp(name, "time-start") == 0) {
        options.time_start_us = (uint32_t)strtoul(value, NULL, 0);
    } else if (strcmp(name, "cmd") == 0) {
        add_timed_command(value);
    } else if (is_setting(name)) {
        add_command(0.0, name, value);
    } else {
        usage("unknown option");
    }
}

static void parse(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--loop") == 0) {
            options.loop = true;
        } else if (strncmp(argv[i], "--", 2) == 0 && i + 1 < argc) {
            take_option(argv[i] + 2, argv[i + 1]);
            i++;
        } else {
            usage("bad option");
        }
    }
    if (options.in == NULL || options.out == NULL) {
        usage("--in and --out are needed");
    }
}

static void on_tx(uint8_t byte)
{
    fputc(byte, out_file);
    header_seen = header_seen || byte == '#';
}

static void on_latched(uint64_t t_us, size_t row, const int16_t lsb[3])
{
    if (served_file != NULL) {
        const stream_row_t *r = &stream.rows[row];
        fprintf(served_file, "%u,%llu,%zu,%u,%d,%d,%d", served_count++, (unsigned long long)t_us, row,
                (unsigned)r->line, lsb[0], lsb[1], lsb[2]);
        if (stream.has_truth) {
            fprintf(served_file, ",%d,%d", r->truth_cdeg[0], r->truth_cdeg[1]);
        }
        fputc('\n', served_file);
    }
}

static FILE *open_output(const char *path)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        perror(path);
        exit(2);
    }
    return file;
}

/* Commands wait for their time and for the first byte of the banner, then for the line before them to be typed. */
static void type_due(size_t *next)
{
    while (header_seen && *next < options.typed_count && options.typed[*next].at_ms <= hal_host_now_ms()) {
        hal_host_type(options.typed[*next].text);
        (*next)++;
    }
}

static int run(void)
{
    hal_host_config_t config = {
        .time_start_us = options.time_start_us, .ppm = options.ppm, .on_tx = on_tx, .on_latched = on_latched
    };
    hal_host_begin(&config, &stream, options.loop);
    app_start();
    double end_ms = options.max_ms;
    size_t next = 0;
    while (hal_host_now_ms() < end_ms) {
        type_due(&next);
        app_pass();
        if (hal_host_watchdog_bite() != 0) {
            fprintf(stderr, "native_replay: the watchdog would have reset at %.1f ms\n", hal_host_now_ms());
            return 3;
        }
        if (hal_host_stream_over() && end_ms >= options.max_ms) {
            end_ms = hal_host_now_ms() + 300.0;
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    parse(argc, argv);
    if (!stream_load(&stream, options.in)) {
        fprintf(stderr, "native_replay: %s\n", stream.error);
        return 2;
    }
    out_file = open_output(options.out);
    if (options.served != NULL) {
        served_file = open_output(options.served);
        fprintf(served_file, "served,t_us,row,line,x_lsb,y_lsb,z_lsb%s\n",
                stream.has_truth ? ",roll_true_cdeg,pitch_true_cdeg" : "");
    }
    int status = run();
    fclose(out_file);
    if (served_file != NULL) {
        fclose(served_file);
    }
    stream_free(&stream);
    return status;
}
