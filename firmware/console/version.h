/* The firmware's name and version as printed in the banner. */
#ifndef VERSION_H
#define VERSION_H

#define FIRMWARE_NAME "tilt-uno"
#define FIRMWARE_VERSION "0.1.0"

#endif
