/* UART rings and their interrupts. Each interrupt moves one byte. */
#include "hal_uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_irq.h"
#include "hal_ring.h"
#include "hal_sleep.h"
#include "machine.h"

enum { TX_SIZE = HAL_UART_TX_SIZE, RX_SIZE = HAL_UART_RX_SIZE, TX_MASK = TX_SIZE - 1, RX_MASK = RX_SIZE - 1 };

_Static_assert(HAL_UART_REACHES(F_CPU / 8 / 256) && !HAL_UART_REACHES(F_CPU / 8 / 260), "the divider is one byte");

static uint8_t tx_buffer[TX_SIZE];
static uint8_t rx_buffer[RX_SIZE];
static hal_ring_t tx;
static hal_ring_t rx;
static volatile uint8_t rx_lost;
static bool rx_gap;
static bool line_used;

/* With its address in a register, each access to a ring takes half the code. */
static inline hal_ring_t *near(hal_ring_t *ring)
{
    MACHINE_POINTER(ring);
    return ring;
}

/* The index of a ring of 256 bytes wraps by itself. */
#if HAL_UART_TX_SIZE == 256
#define WRAP_TAIL
#else
#define WRAP_TAIL "andi r30, %[mask]\n\t"
#endif

/*
 * TXC0 marks the last stop bit only if it is cleared after the last byte is in UDR0: a frame that ends before that sets
 * it. The other writable bits of UCSR0A are U2X0 and one that is 0.
 */
enum { SENDS_LAST = _BV(U2X0) | _BV(TXC0) };

/*
 * UDR0 = tx_buffer[tx.tail++]; after the last byte, disable this interrupt and clear TXC0. Hand-written, because it
 * runs for every byte sent: the compiler's entry and exit would add 12 cycles, for 53 in all, 0.3 % of the processor at
 * 100 rows a second.
 */
ISR(USART_UDRE_vect, ISR_NAKED)
{
    __asm__ volatile(
        "push r24\n\t"
        "in r24, __SREG__\n\t"
        "push r24\n\t"
        "push r30\n\t"
        "push r31\n\t"
        "lds r30, %[tail]\n\t"
        "ldi r31, 0\n\t"
        "subi r30, lo8(-(%[buffer]))\n\t"
        "sbci r31, hi8(-(%[buffer]))\n\t"
        "ld r24, Z\n\t"
        "sts %[udr], r24\n\t"
        "lds r30, %[tail]\n\t"
        "inc r30\n\t" WRAP_TAIL "sts %[tail], r30\n\t"
        "lds r24, %[head]\n\t"
        "cpse r24, r30\n\t"
        "rjmp 1f\n\t"
        "lds r24, %[ucsrb]\n\t"
        "andi r24, %[off]\n\t"
        "sts %[ucsrb], r24\n\t"
        "ldi r24, %[last]\n\t"
        "sts %[ucsra], r24\n"
        "1:\tpop r31\n\t"
        "pop r30\n\t"
        "pop r24\n\t"
        "out __SREG__, r24\n\t"
        "pop r24\n\t"
        "reti"
        :
        : [tail] "i"(&tx.tail), [head] "i"(&tx.head), [buffer] "i"(tx_buffer), [udr] "i"(_SFR_MEM_ADDR(UDR0)),
          [ucsrb] "i"(_SFR_MEM_ADDR(UCSR0B)), [off] "n"(0xFF & ~_BV(UDRIE0)), [mask] "n"(TX_MASK),
          [ucsra] "i"(_SFR_MEM_ADDR(UCSR0A)), [last] "n"(SENDS_LAST));
}

/*
 * Puts a received byte into the ring. 0 replaces a damaged byte, and the first byte that fits after some that did not,
 * so that the line it belongs to can be refused. Hand-written too: at 1,000,000 baud a byte comes every 160 cycles. It
 * does
 *
 *   uint8_t next = (rx.head + 1) & RX_MASK, damage = UCSR0A & (FE0 | DOR0), byte = UDR0;
 *   if (next == rx.tail)  { rx_gap = 1; count }
 *   else                  { if (damage) { count; byte = 0 } if (rx_gap) { rx_gap = 0; byte = 0 } store }
 */
ISR(USART_RX_vect, ISR_NAKED)
{
    __asm__ volatile(
        "push r24\n\t"
        "in r24, __SREG__\n\t"
        "push r24\n\t"
        "push r25\n\t"
        "push r30\n\t"
        "push r31\n\t"
        "sbi %[wake], 0\n\t"
        "lds r30, %[head]\n\t"
        "mov r31, r30\n\t"
        "inc r31\n\t"
        "andi r31, %[mask]\n\t"
        "lds r24, %[tail]\n\t"
        "cp r24, r31\n\t"
        "lds r24, %[ucsra]\n\t"
        "lds r25, %[udr]\n\t"
        "brne 1f\n\t"
        "ldi r31, 1\n\t"
        "sts %[gap], r31\n\t"
        "rcall 4f\n\t"
        "rjmp 3f\n"
        "1:\tandi r24, %[damage]\n\t"
        "breq 2f\n\t"
        "ldi r25, 0\n\t"
        "rcall 4f\n"
        "2:\tlds r24, %[gap]\n\t"
        "sbrc r24, 0\n\t"
        "ldi r25, 0\n\t"
        "ldi r24, 0\n\t"
        "sts %[gap], r24\n\t"
        "sts %[head], r31\n\t"
        "ldi r31, 0\n\t"
        "subi r30, lo8(-(%[buffer]))\n\t"
        "sbci r31, hi8(-(%[buffer]))\n\t"
        "st Z, r25\n"
        "3:\tpop r31\n\t"
        "pop r30\n\t"
        "pop r25\n\t"
        "pop r24\n\t"
        "out __SREG__, r24\n\t"
        "pop r24\n\t"
        "reti\n"
        "4:\tlds r24, %[lost]\n\t"
        "inc r24\n\t"
        "breq 5f\n\t"
        "sts %[lost], r24\n"
        "5:\tret"
        :
        : [head] "i"(&rx.head), [tail] "i"(&rx.tail), [buffer] "i"(rx_buffer), [gap] "i"(&rx_gap), [lost] "i"(&rx_lost),
          [mask] "n"(RX_MASK), [damage] "n"(_BV(FE0) | _BV(DOR0)), [ucsra] "i"(_SFR_MEM_ADDR(UCSR0A)),
          [udr] "i"(_SFR_MEM_ADDR(UDR0)), [wake] "I"(_SFR_IO_ADDR(GPIOR0))
        : "memory");
}

void hal_uart_init(uint32_t baud)
{
    UCSR0B = 0;
    line_used = false;
    /* simulators compute the byte time when UBRR0L is written, so write it last */
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UBRR0H = 0;
    UBRR0L = (uint8_t)((uint16_t)(F_CPU / 4 / baud - 1) / 2); /* F_CPU / 8 / baud, rounded, minus one */
    UCSR0B = _BV(TXEN0) | _BV(RXEN0) | _BV(RXCIE0);
}

uint8_t hal_uart_tx_room(void)
{
    return hal_ring_room(near(&tx), TX_MASK);
}

void hal_uart_tx_stage(uint8_t byte)
{
    hal_ring_stage(near(&tx), tx_buffer, TX_MASK, byte);
}

void hal_uart_tx_commit(void)
{
    hal_ring_t *r = near(&tx);
    if (r->staged == r->head) {
        return;
    }
    hal_ring_commit(r);
    line_used = true;
    hal_irq_state_t state = hal_irq_save();
    UCSR0B |= _BV(UDRIE0);
    hal_irq_restore(state);
}

void hal_uart_tx_discard(void)
{
    hal_ring_discard(&tx);
}

bool hal_uart_tx_write(const char *line, uint8_t length)
{
    if (hal_uart_tx_room() < length) {
        return false;
    }
    uint8_t at = tx.staged;
    while (length-- != 0) {
        tx_buffer[at++] = (uint8_t)*line++;
        at = (uint8_t)(at & TX_MASK);
    }
    tx.staged = at;
    hal_uart_tx_commit();
    return true;
}

bool hal_uart_tx_idle(void)
{
    return hal_ring_empty(&tx) && (!line_used || (UCSR0A & _BV(TXC0)));
}

uint8_t hal_uart_tx_sent(void)
{
    return tx.tail;
}

bool hal_uart_rx(uint8_t *byte)
{
    hal_ring_t *r = near(&rx);
    if (hal_ring_empty(r)) {
        return false;
    }
    *byte = hal_ring_take(r, rx_buffer, RX_MASK);
    return true;
}

uint8_t hal_uart_rx_lost(void)
{
    return rx_lost;
}
