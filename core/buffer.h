#pragma once
// Large arrays of plain values that are written before they are read: aligned to cache lines, not cleared,
// and on huge pages where the system grants them (fewer page faults, which cost more than the pixels do).

#include <cstddef>
#include <type_traits>
#include <utility>

#include "core/image.h"

namespace obscura {

void* allocate_pages(std::size_t bytes);
void free_pages(void* p, std::size_t bytes) noexcept;

/// Owns `size` values, uninitialised.
template <class T>
requires std::is_trivially_copyable_v<T>
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t size)
        : data_(static_cast<T*>(allocate_pages(size * sizeof(T)))), size_(size), capacity_(size) {}
    Buffer(Buffer&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)),
          size_(std::exchange(other.size_, 0)),
          capacity_(std::exchange(other.capacity_, 0)) {}
    Buffer& operator=(Buffer&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
        return *this;
    }
    ~Buffer() { free_pages(data_, capacity_ * sizeof(T)); }

    /// Room for `size` values; what was there is lost. Memory is kept when it is large enough, else it is
    /// given back before more is asked for: never both at once.
    void reset(std::size_t size) {
        if (size > capacity_) {
            *this = Buffer();
            *this = Buffer(size);
        }
        size_ = size;
    }
    T* data() { return data_; }
    const T* data() const { return data_; }
    std::size_t size() const { return size_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    T* begin() { return data_; }
    T* end() { return data_ + size_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }

  private:
    T* data_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
};

/// Copies `bytes` to memory that will not be read soon, past the caches: half the traffic of an ordinary
/// copy, which reads each line before it overwrites it. Falls back to an ordinary copy where `to` is not
/// aligned to 16 bytes. Call finish_streaming() before another thread may read.
void copy_streaming(void* to, const void* from, std::size_t bytes) noexcept;
void finish_streaming() noexcept;

/// A large uninitialised picture: a Buffer seen as rows.
template <class T>
struct Raster {
    int width = 0, height = 0;
    Buffer<T> pixels;

    Raster() = default;
    Raster(int width_, int height_) { reset(width_, height_); }
    void reset(int width_, int height_) {
        width = width_;
        height = height_;
        pixels.reset(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    }
    ImageView<T> view() { return {pixels.data(), width, height, width}; }
    ImageView<const T> view() const { return {pixels.data(), width, height, width}; }
};

}  // namespace obscura
