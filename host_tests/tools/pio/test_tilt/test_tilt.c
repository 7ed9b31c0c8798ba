/* The test of make; PlatformIO wants a folder for each program, and the headers here to find the libraries. */
#include "filter_list.h"
#include "tilt.h"
#include "unity.h"

#include "../../../support/random32.c"
#include "../../../support/test.c"
#include "../../../tilt/test_tilt.c"
