#include <avr/io.h>
#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <avr/pgmspace.h>
#include <stdint.h>
#define CAT_(a,b) a##b
#define CAT(a,b) CAT_(a,b)
#define STR_(x) #x
#define STR(x) STR_(x)
#ifdef NEW
#include "filter.h"
static filter_t f; 
static void begin(uint16_t rate){ filter_config_t c=filter_defaults(&CAT(filter_law_,LAW),rate); 
#ifdef A1
 c.value[0]=-19661;
#endif
 filter_init(&f,&CAT(filter_law_,LAW),&c);}
#define UPDATE(z) filter_update(&f,z)
#else
#include STR(LAW.h)
static CAT(LAW,_t) f;
static void begin(uint16_t rate){ CAT(LAW,_config_t) c; CAT(LAW,_defaults)(&c,rate);
#ifdef A1
 c.a1_q16=-19661;
#endif
 CAT(LAW,_init)(&f,&c);}
#define UPDATE(z) CAT(LAW,_update)(&f,z)
#endif
static volatile int32_t sink; static volatile int16_t zz;
static void __attribute__((noinline)) up(void){ sink=UPDATE(zz);} 
static void __attribute__((noinline)) nothing(void){ sink=zz;} 
static void out(char c){ while(!(UCSR0A&(1<<UDRE0))){} UDR0=c;}
static void num(uint32_t v){ char b[11]; uint8_t n=0; do{b[n++]=(char)('0'+v%10);v/=10;}while(v); while(n) out(b[--n]);}
static uint32_t rs; static uint32_t rnd(void){uint32_t v=rs;v^=v<<13;v^=v>>17;v^=v<<5;return rs=v;}
static uint16_t timed(void(*fn)(void)){ uint16_t a=TCNT1; fn(); return (uint16_t)(TCNT1-a);} 
static uint16_t hist[600];
int main(void){ UBRR0=0; UCSR0A=1<<U2X0; UCSR0B=1<<TXEN0; TCCR1B=1<<CS10; uint16_t base=timed(nothing); sink=0;
 static const uint16_t rates[] PROGMEM={1000,4000,8000,125};
 uint32_t n=0; uint16_t mx=0;
 for(uint8_t r=0;r<4;r++){ begin(pgm_read_word(&rates[r])); rs=12345+r; int16_t pos=0; int16_t off=0;
  for(uint16_t i=0;i<1500;i++){ uint32_t a=rnd(); pos=(int16_t)((i&512)? 100-(i&511)/3 : (i&511)/3); if(i%400==399) off=(int16_t)((a>>8)%3000)-1500; int16_t z=(int16_t)(pos+off+(int16_t)((a&15)+((a>>4)&15))-15); uint8_t w=(uint8_t)(a>>20); if(w<15) z=(int16_t)(z+(int16_t)((a>>8)%4000)-2000); if(w>=250) z=(int16_t)(z+((a>>8)&63));
   zz=z; uint16_t t=(uint16_t)(timed(up)-base); if(t>mx) mx=t; uint16_t h=t>>3; if(h>599)h=599; hist[h]++; n++; } }
 uint32_t half=n/2,c=0; uint16_t med=0; for(uint16_t i=0;i<600;i++){c+=hist[i]; if(c>=half){med=(uint16_t)(i<<3);break;}}
 num(med); out(' '); num(mx); out('\n'); while(!(UCSR0A&(1<<TXC0))){} cli(); sleep_enable(); sleep_cpu(); for(;;){} }
