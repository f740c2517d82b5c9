// Vectors handed to numpy without a copy: the array owns the memory, whatever made it.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace pirsim::python {

/// Read-only, in C order. `As`: the element type that numpy shows, of the same size.
template <typename As, typename T>
[[nodiscard]] nanobind::object to_numpy_as(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  static_assert(sizeof(As) == sizeof(T));
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const void* data = owned->data();
  nanobind::capsule owner(owned.get(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  (void)owned.release();
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, const As>(data, shape.size(), shape.begin(), owner));
}
template <typename T>
[[nodiscard]] nanobind::object to_numpy(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  return to_numpy_as<T>(std::move(values), shape);
}

}  // namespace pirsim::python
