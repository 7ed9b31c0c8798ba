/* The firmware's entry point. */
#include "app/app.h"

int main(void)
{
    app_start();
    for (;;) {
        app_pass();
    }
}
