// Shadows of the camera's points that stand together before the light, in the order in which they come;
// others become samples. See exact_ref.cpp for the meaning of each step.

#include "raster/exact/exact_chunks.h"
#include "raster/exact/exact_nearby.h"

namespace obscura::OBSCURA_ISA {

void exact_locate(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                  std::uint32_t* lit, ExactCounts& counts) noexcept {
    Nearby nearby;
    locate_chunks(points, light, samples, lit,
                  [&](const ExactView& view, std::int32_t v, Bunch* bunch, int n) {
                      // Where too much is near, samples wait.
                      const bool fits = collect(light, view, bunch, n, nearby, counts);
                      for (int b = 0; b < n; ++b) {
                          const std::uint32_t asked = bunch[b].open;
                          if (fits && darken_near(points, light, view, nearby, most_near, bunch[b], counts)) {
                              counts.samples += __builtin_popcount(asked);
                              lit[bunch[b].point[0] / 16] &= ~(asked & ~bunch[b].open);
                          } else {
                              append(bunch[b], v, samples);
                          }
                      }
                  });
}

}  // namespace obscura::OBSCURA_ISA
