/*
 * HAL_BODY starts the inline body of a function that a contract declares. The compiler compares the two, inlines the
 * body at every call and keeps no copy. (static inline could not follow the contract's plain declaration.)
 */
#ifndef HAL_BODY_H
#define HAL_BODY_H

#define HAL_BODY extern inline __attribute__((gnu_inline, always_inline))

#endif
