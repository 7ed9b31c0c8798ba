/* The test of make; PlatformIO wants a folder for each program, and the headers here to find the libraries. */
#include "filter_any.h"
#include "tilt.h"
#include "unity.h"

#include "../../support_filter_promises.c"
#include "../../support_filters.c"
#include "../../test_tilt.c"
