/*
 * HAL_BODY begins an inline body of a function that a contract has declared. The compiler compares the two, puts the
 * body in place of every call and keeps no copy. (static inline could not follow the contract's plain declaration.)
 */
#ifndef HAL_BODY_H
#define HAL_BODY_H

#define HAL_BODY extern inline __attribute__((gnu_inline, always_inline))

#endif
