/*
 * Put before every file of lib/filters (-include, compiled as C++): its 16- and 32-bit integers become numbers that
 * count what is done with them, so the shipped code itself tells how many multiplications and additions a sample takes.
 *
 * One call of a product primitive of fx.h is one multiplication, however many bytes it takes, and one reciprocal is one
 * division; what they do inside does not count, nor does a multiplication by a constant power of two, which is a shift.
 * Additions are sums, differences and increments of two numbers. Comparisons, shifts, masks, signs, conversions and
 * 8-bit counters do not count.
 */
#ifndef COUNTING_H
#define COUNTING_H

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace counting
{
struct Tally {
    long products;
    long sums;
    long divisions;
    long shifts; // what is one with rounding
    int suspended;
};
extern Tally tally;

template <class T> struct Number;
template <class T> struct raw_of {
    using type = T;
};
template <class T> struct raw_of<Number<T>> {
    using type = T;
};
template <class T> using raw_t = typename raw_of<T>::type;
template <class T> constexpr bool is_number = !std::is_same_v<T, raw_t<T>>;

// A trivial type, so that it may live in unions and be cleared by bytes.
template <class T> struct Number {
    T v;

    Number() = default;
    template <class U, std::enable_if_t<std::is_arithmetic_v<U> || std::is_enum_v<U>, int> = 0>
    constexpr Number(U u) : v(static_cast<T>(u))
    {
    }
    template <class U, std::enable_if_t<(sizeof(U) < sizeof(T)), int> = 0>
    constexpr Number(Number<U> u) : v(static_cast<T>(u.v))
    {
    }
    template <class U, std::enable_if_t<(sizeof(U) >= sizeof(T)), int> = 0>
    constexpr explicit Number(Number<U> u) : v(static_cast<T>(u.v))
    {
    }
    template <class U, std::enable_if_t<std::is_arithmetic_v<U> || std::is_enum_v<U>, int> = 0>
    constexpr explicit operator U() const
    {
        return static_cast<U>(v);
    }
};

template <class T> constexpr auto raw(T t)
{
    if constexpr (is_number<T>) {
        return t.v;
    } else {
        return t;
    }
}

// The rule of make puts it around every subscript: C++ takes no class there.
template <class T> constexpr std::ptrdiff_t index(T t)
{
    return static_cast<std::ptrdiff_t>(raw(t));
}

template <class V> constexpr auto made(V v)
{
    return Number<V>(v);
}

inline void sum()
{
    tally.sums += tally.suspended == 0;
}

template <class A, class B> void product(A a, B b)
{
    const bool shift_a = !is_number<A> && (raw(a) & (raw(a) - 1)) == 0;
    const bool shift_b = !is_number<B> && (raw(b) & (raw(b) - 1)) == 0;
    tally.products += tally.suspended == 0 && !shift_a && !shift_b;
}

template <class A, class B>
using both = std::enable_if_t<(is_number<A> && (is_number<B> || std::is_arithmetic_v<B> || std::is_enum_v<B>)) ||
                                  (is_number<B> && (std::is_arithmetic_v<A> || std::is_enum_v<A>)),
                              int>;

#define COUNTING_BINARY(op, note)                                                    \
    template <class A, class B, both<A, B> = 0> constexpr auto operator op(A a, B b) \
    {                                                                                \
        note;                                                                        \
        return made(raw(a) op raw(b));                                               \
    }                                                                                \
    template <class A, class B> Number<A> &operator op##=(Number<A> &a, B b)         \
    {                                                                                \
        note;                                                                        \
        a.v = static_cast<A>(a.v op raw(b));                                         \
        return a;                                                                    \
    }
COUNTING_BINARY(+, sum())
COUNTING_BINARY(-, sum())
COUNTING_BINARY(*, product(a, b))
COUNTING_BINARY(/, tally.divisions += tally.suspended == 0)
COUNTING_BINARY(%, tally.divisions += tally.suspended == 0)
COUNTING_BINARY(&, )
COUNTING_BINARY(|, )
COUNTING_BINARY(^, )
COUNTING_BINARY(<<, )
COUNTING_BINARY(>>, )
#undef COUNTING_BINARY

#define COUNTING_COMPARE(op)                                                         \
    template <class A, class B, both<A, B> = 0> constexpr bool operator op(A a, B b) \
    {                                                                                \
        return raw(a) op raw(b);                                                     \
    }
COUNTING_COMPARE(==)
COUNTING_COMPARE(!=)
COUNTING_COMPARE(<)
COUNTING_COMPARE(<=)
COUNTING_COMPARE(>)
COUNTING_COMPARE(>=)
#undef COUNTING_COMPARE

template <class T> constexpr auto operator-(Number<T> a)
{
    return made(-a.v);
}
template <class T> constexpr auto operator~(Number<T> a)
{
    return made(~a.v);
}
template <class T> Number<T> &operator++(Number<T> &a)
{
    sum();
    a.v++;
    return a;
}
template <class T> Number<T> operator++(Number<T> &a, int)
{
    const Number<T> before = a;
    ++a;
    return before;
}
template <class T> Number<T> &operator--(Number<T> &a)
{
    sum();
    a.v--;
    return a;
}
template <class T> Number<T> operator--(Number<T> &a, int)
{
    const Number<T> before = a;
    --a;
    return before;
}

// A primitive as one operation; its arguments are there before and have been counted.
template <class F, class... A> auto one(long Tally::*kind, F f, A... a)
{
    tally.*kind += tally.suspended == 0;
    tally.suspended++;
    auto result = f(a...);
    tally.suspended--;
    return result;
}
} // namespace counting

#define int16_t counting::Number<std::int16_t>
#define uint16_t counting::Number<std::uint16_t>
#define int32_t counting::Number<std::int32_t>
#define uint32_t counting::Number<std::uint32_t>

#include "fx.h"

#ifndef COUNTING_PRIMITIVES
#define COUNTING_ONE(kind, f, ...) \
    counting::one(                 \
        &counting::Tally::kind, [](auto... counting_a) { return (f)(counting_a...); }, __VA_ARGS__)
#define filter_fx_mul_uq16(...) COUNTING_ONE(products, filter_fx_mul_uq16, __VA_ARGS__)
#define filter_fx_mul16_uq16(...) COUNTING_ONE(products, filter_fx_mul16_uq16, __VA_ARGS__)
#define filter_fx_mul24_uq16(...) COUNTING_ONE(products, filter_fx_mul24_uq16, __VA_ARGS__)
#define filter_fx_mul24_uq24(...) COUNTING_ONE(products, filter_fx_mul24_uq24, __VA_ARGS__)
#define filter_fx_mul_uq24(...) COUNTING_ONE(products, filter_fx_mul_uq24, __VA_ARGS__)
#define filter_fx_scaled_mul(...) COUNTING_ONE(products, filter_fx_scaled_mul, __VA_ARGS__)
#define filter_fx_high_u16(...) COUNTING_ONE(products, filter_fx_high_u16, __VA_ARGS__)
#define fx_reciprocal_uq16(...) COUNTING_ONE(divisions, fx_reciprocal_uq16, __VA_ARGS__)
#define filter_fx_inverse_uq16(...) COUNTING_ONE(divisions, filter_fx_inverse_uq16, __VA_ARGS__)
#define fx_inverse_m_uq16(...) COUNTING_ONE(divisions, fx_inverse_m_uq16, __VA_ARGS__)
#define fx_sixteenth(...) COUNTING_ONE(shifts, fx_sixteenth, __VA_ARGS__)
#define fx_without_part(...) COUNTING_ONE(shifts, fx_without_part, __VA_ARGS__)
#define filter_fx_scaled_div(...) COUNTING_ONE(divisions, filter_fx_scaled_div, __VA_ARGS__)
#endif

#endif
