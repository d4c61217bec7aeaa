// Arrays and the whole numbers that point into them: ids and indices are int where a file or another array holds them,
// sizes of arrays are size_t. The step from one to the other is here, once.
#pragma once
#include <concepts>
#include <cstddef>
#include <iterator>
#include <utility>

namespace flaneur {

// array[id]. The id is not checked: it must not be negative, and less than the array's size.
template <typename Array, std::integral Id>
constexpr decltype(auto) At(Array& array, Id id) {
  return array[static_cast<size_t>(id)];
}

// Whether array[id] is there.
template <typename Array, std::integral Id>
constexpr bool InRange(const Array& array, Id id) {
  return std::cmp_greater_equal(id, 0) && std::cmp_less(id, std::size(array));
}

// Where a cell lies in an array of rows, one after the other.
constexpr size_t RowMajor(int row, int columns, int column) {
  return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
}

// How many elements an array has, as ids are counted: less than 2^31.
template <typename Array>
constexpr int Count(const Array& array) {
  return static_cast<int>(std::size(array));
}

}  // namespace flaneur
