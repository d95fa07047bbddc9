// Compares types of runstone.h with those that another language declares for P/Invoke.
#pragma once
#include <runstone.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Stands for a pointer whose target the other language does not name.
struct AnyPointer {};

/// True if a value of the header's type C can be declared as `Other`. Constness does not matter.
template <class C, class Other>
constexpr bool matches = std::is_same_v<std::remove_cv_t<C>, Other>;
template <class C>
constexpr bool matches<C*, AnyPointer> = true;
template <class C, class Other>
constexpr bool matches<C*, Other*> =
    matches<std::remove_cv_t<C>, Other> ||
    (std::is_same_v<std::remove_cv_t<C>, char> && std::is_same_v<Other, std::uint8_t>);

/// True if a function of the header can be called with this result and these parameters.
template <class Function, class Result, class... Parameters>
constexpr bool is_called = false;
template <class CResult, class... CParameters, class Result, class... Parameters>
  requires(sizeof...(CParameters) == sizeof...(Parameters))
constexpr bool is_called<CResult(CParameters...), Result, Parameters...> =
    matches<CResult, Result> && (matches<CParameters, Parameters> && ...);
