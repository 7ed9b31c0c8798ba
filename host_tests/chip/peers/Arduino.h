/* As much of the Arduino core as other people's filters ask for: the benchmark needs no core. */
#ifndef ARDUINO_H
#define ARDUINO_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define F(text) text

struct Print {
    template <class T> size_t print(T)
    {
        return 0;
    }
};

struct NoSerial {
    template <class T> void println(T) {}
};
static NoSerial Serial;

template <class A, class B> static inline A max(A a, B b)
{
    return a > b ? a : b;
}

#endif
