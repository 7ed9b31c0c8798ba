/* The test of make; PlatformIO wants a folder for each program, and the headers here to find the libraries. */
#include "tilt.h"
#include "unity.h"

#include "../../test_tilt.c"
