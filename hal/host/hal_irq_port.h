/* On the PC all of hal_irq.h is in hal_host.c. */
#ifndef HAL_IRQ_PORT_H
#define HAL_IRQ_PORT_H

#endif
