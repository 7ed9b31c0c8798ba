/* The reader of recorded streams. Formats and errors as in design.md, "Streams". */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stream.h"
#include "support/test.h"

static char path[] = "/tmp/test_stream_XXXXXX";
static stream_t stream;
static bool loaded;

void setUp(void)
{
    loaded = false;
}

void tearDown(void)
{
    if (loaded) {
        stream_free(&stream);
    }
}

static bool load_bytes(const char *text, size_t length)
{
    FILE *file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_size_t(length, fwrite(text, 1, length, file));
    fclose(file);
    loaded = stream_load(&stream, path);
    return loaded;
}

static void load(const char *text)
{
    bool good = load_bytes(text, strlen(text));
    TEST_ASSERT_TRUE_MESSAGE(good, stream.error);
}

/* Refused with exactly FILE:LINE: reason, and nothing kept. */
static void refused(const char *text, unsigned line, const char *reason)
{
    char expected[256];
    snprintf(expected, sizeof expected, "%s:%u: %s", path, line, reason);
    TEST_ASSERT_FALSE(load_bytes(text, strlen(text)));
    TEST_ASSERT_EQUAL_STRING(expected, stream.error);
    TEST_ASSERT_NULL(stream.rows);
    TEST_ASSERT_EQUAL_size_t(0, stream.count);
}

static void assert_row(size_t i, uint64_t t_us, int x, int y, int z)
{
    TEST_ASSERT_EQUAL_UINT64(t_us, stream.rows[i].t_us);
    TEST_ASSERT_EQUAL_INT16(x, stream.rows[i].lsb[0]);
    TEST_ASSERT_EQUAL_INT16(y, stream.rows[i].lsb[1]);
    TEST_ASSERT_EQUAL_INT16(z, stream.rows[i].lsb[2]);
}

TEST(test_plain_rows_and_rate)
{
    load("t_us,x,y,z\n5000,1,-2,256\n15000,-4096,4095,0\n25000,3,4,5\n");
    TEST_ASSERT_EQUAL_size_t(3, stream.count);
    assert_row(0, 0, 1, -2, 256);
    assert_row(1, 10000, -4096, 4095, 0);
    assert_row(2, 20000, 3, 4, 5);
    TEST_ASSERT_EQUAL_UINT32(2, stream.rows[0].line);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, stream.rate_hz);
    TEST_ASSERT_FALSE(stream.has_truth);
}

TEST(test_rate_is_the_median_step)
{
    /* steps 2500, 2500, 40000, 2400, 2500: median 2500 us = 400 Hz, whatever the gap */
    load("t_us,x,y,z\n0,0,0,0\n2500,0,0,0\n5000,0,0,0\n45000,0,0,0\n47400,0,0,0\n49900,0,0,0\n");
    TEST_ASSERT_EQUAL_DOUBLE(400.0, stream.rate_hz);
}

TEST(test_one_row_has_no_rate)
{
    load("t_us,x,y,z\n77,1,2,3\n");
    TEST_ASSERT_EQUAL_DOUBLE(0.0, stream.rate_hz);
    assert_row(0, 0, 1, 2, 3);
}

TEST(test_columns_by_name_others_ignored)
{
    load("note,z_lsb,y_lsb,x_lsb,t_us,temperature\nhello,3,2,1,100,2.5\n,6,5,4,300,\n");
    assert_row(0, 0, 1, 2, 3);
    assert_row(1, 200, 4, 5, 6);
}

TEST(test_truth_columns)
{
    load("t_us,x,y,z,roll_true_cdeg,pitch_true_cdeg\n0,0,0,256,-18000,9000\n1,0,0,256,18000,-9000\n");
    TEST_ASSERT_TRUE(stream.has_truth);
    TEST_ASSERT_EQUAL_INT16(-18000, stream.rows[0].truth_cdeg[0]);
    TEST_ASSERT_EQUAL_INT16(-9000, stream.rows[1].truth_cdeg[1]);
}

TEST(test_bom_crlf_comments_blank_lines_and_padding)
{
    load("\xEF\xBB\xBF# a comment\r\n\r\n t_us , x,y,z\r\n# another, with, commas\r\n 0, 1,\t2 , 3\r\n\r\n10,4,5,6");
    TEST_ASSERT_EQUAL_size_t(2, stream.count);
    assert_row(1, 10, 4, 5, 6);
    TEST_ASSERT_EQUAL_UINT32(7, stream.rows[1].line);
}

TEST(test_wrap_of_the_32_bit_clock)
{
    /* 4294960000 -> 2704: 2^32 - 4294960000 + 2704 = 10000 us on; and once more 2^32 later */
    load("t_us,x,y,z\n4294960000,1,0,0\n2704,2,0,0\n4294960000,3,0,0\n2704,4,0,0\n");
    assert_row(1, 10000, 2, 0, 0);
    assert_row(2, 4294967296ull, 3, 0, 0);
    assert_row(3, 4294977296ull, 4, 0, 0);
}

TEST(test_step_back_of_exactly_2_31_is_an_error_one_more_is_a_wrap)
{
    refused("t_us,x,y,z\n2147483648,0,0,0\n0,0,0,0\n", 3, "time goes backwards: 0 after 2147483648");
    load("t_us,x,y,z\n2147483649,0,0,0\n0,0,0,0\n");
    assert_row(1, 2147483647ull, 0, 0, 0);
}

TEST(test_repeated_header_begins_a_segment_one_period_later)
{
    load("t_us,x,y,z\n100,1,0,0\n10100,2,0,0\n20100,3,0,0\nt_us,x,y,z\n7,4,0,0\n10007,5,0,0\n");
    TEST_ASSERT_EQUAL_size_t(5, stream.count);
    assert_row(3, 30000, 4, 0, 0);
    assert_row(4, 40000, 5, 0, 0);
}

TEST(test_a_second_segment_may_have_other_columns)
{
    load("t_us,x,y,z\n0,1,2,3\n10000,1,2,3\nx_lsb,y_lsb,z_lsb,t_us,flags\n4,5,6,500,0\n");
    assert_row(2, 20000, 4, 5, 6);
}

/* The firmware's own output: banner, header, rows, a restart, a reply, coasted and faulty rows. */
TEST(test_output_of_the_firmware_is_a_stream)
{
    load("# tilt-uno 0.1.0: roll and pitch from an ADXL345\n"
         "# reset: power on\n"
         "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags\n"
         "17657,46,14,-242,180,55,-945,17669,-1074,128\n"
         "27657,44,12,-244,176,51,-949,17694,-1047,0\n"
         "37657,44,12,-244,176,51,-949,17694,-1047,2\n"
         "# fault 1: no sensor answers\n"
         "47657,44,12,-244,176,51,-949,17694,-1047,18\n"
         "57657,43,12,-243,176,51,-949,17694,-1047,1541\n"
         "# tilt-uno 0.1.0\n"
         "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags\n"
         "17657,46,14,-242,180,55,-945,17669,-1074,128\n");
    TEST_ASSERT_EQUAL_size_t(6, stream.count);
    TEST_ASSERT_FALSE(stream.rows[1].missing);
    TEST_ASSERT_TRUE(stream.rows[2].missing);
    TEST_ASSERT_TRUE(stream.rows[3].missing);
    TEST_ASSERT_FALSE(stream.rows[4].missing);
    assert_row(5, 50000, 46, 14, -242);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, stream.rate_hz);
}

TEST(test_refuses_a_file_that_is_not_there)
{
    TEST_ASSERT_FALSE(stream_load(&stream, "/nowhere/stream.csv"));
    TEST_ASSERT_EQUAL_STRING("/nowhere/stream.csv:0: cannot open: No such file or directory", stream.error);
}

TEST(test_refuses_empty_files)
{
    refused("", 1, "the file is empty");
    refused("# only a comment\n\n", 2, "no header");
    refused("t_us,x,y,z\n# nothing\n", 2, "no rows after the header");
}

#define HINT "comes first): tilt import FILE converts other recordings"

TEST(test_refuses_a_missing_column)
{
    refused("t_us,x,z\n0,1,2\n", 1, "missing column y (a header with t_us and x,y,z or x_lsb,y_lsb,z_lsb " HINT);
    refused("0,1,2,3\n", 1, "missing column t_us (a header with t_us and x,y,z or x_lsb,y_lsb,z_lsb " HINT);
    refused("t_us,x,y,z\n0,1,2,3\nt_us,x,y\n", 3, "missing column z");
}

TEST(test_refuses_a_wrong_field_count)
{
    refused("t_us,x,y,z\n0,1,2,3\n10,1,2\n", 3, "3 fields where the header has 4");
    refused("t_us,x,y,z\n0,1,2,3,\n", 2, "5 fields where the header has 4");
}

TEST(test_refuses_what_is_no_whole_number)
{
    refused("t_us,x,y,z\n0,1,abc,3\n", 2, "y is not a whole number: 'abc'");
    refused("t_us,x,y,z\n0,1,,3\n", 2, "y is not a whole number: ''");
    refused("t_us,x,y,z\n0,1,2,3.5\n", 2, "z is not a whole number: '3.5': tilt import FILE converts other units");
    refused("t_us,x,y,z\n1e3,1,2,3\n", 2, "t_us is not a whole number: '1e3'");
    refused("t_us,x,y,z\n0,nan,2,3\n", 2, "x is not a whole number: 'nan'");
    refused("t_us,x,y,z\n0,1 2,2,3\n", 2, "x is not a whole number: '1 2'");
    refused("t_us,x,y,z,flags\n0,1,2,3,?\n", 2, "flags is not a whole number: '?'");
    refused("t_us,x,y,z\n0,99999999999999999999,2,3\n", 2, "x is not a whole number: '99999999999999999999'");
}

TEST(test_refuses_values_outside_the_sensor)
{
    refused("t_us,x,y,z\n0,4096,2,3\n", 2, "x is outside -4096..4095: 4096");
    refused("t_us,x,y,z\n0,1,2,-4097\n", 2, "z is outside -4096..4095: -4097");
    refused("t_us,x,y,z\n-1,1,2,3\n", 2, "t_us is outside 0..1000000000000000: -1");
    refused("t_us,x,y,z,roll_true_cdeg,pitch_true_cdeg\n0,1,2,3,18001,0\n", 2,
            "roll_true_cdeg is outside -18000..18000: 18001");
}

TEST(test_refuses_time_going_backwards)
{
    refused("t_us,x,y,z\n0,1,2,3\n20,1,2,3\n19,1,2,3\n", 4, "time goes backwards: 19 after 20");
    /* beyond 32 bits there is no counter that could have wrapped */
    refused("t_us,x,y,z\n9000000000,1,2,3\n0,1,2,3\n", 3, "time goes backwards: 0 after 9000000000");
}

TEST(test_refuses_binary)
{
    static const char bytes[] = "t_us,x,y,z\n0,1,2,3\n10,\0,2,3\n";
    TEST_ASSERT_FALSE(load_bytes(bytes, sizeof bytes - 1));
    TEST_ASSERT_NOT_NULL(strstr(stream.error, ":3: a NUL byte: no text, or UTF-16, which tilt import FILE converts"));
}

TEST(test_recordings)
{
    /* rows and duration as in the recordings' index.csv */
    static const char *const name = "../shared/streams/open/gest-100-2g-a.csv";
    if (access(name, R_OK) != 0) {
        TEST_IGNORE_MESSAGE("no ../shared/streams");
    }
    loaded = stream_load(&stream, name);
    TEST_ASSERT_TRUE_MESSAGE(loaded, stream.error);
    TEST_ASSERT_EQUAL_size_t(8848, stream.count);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, stream.rate_hz);
}

int main(void)
{
    int file = mkstemp(path);
    if (file < 0) {
        perror(path);
        return 1;
    }
    close(file);
    unlink(path);
    return test_all();
}
