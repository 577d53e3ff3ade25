// The checksum of files: CRC-32 of ISO 3309, as zlib and gzip have it.
//
// Processors with products without carry fold sixteen bytes at a time, four of them side by side (V. Gopal et al., Fast CRC
// Computation for Generic Polynomials Using PCLMULQDQ Instruction, Intel, 2009). On others zlib is faster.
#pragma once

#include <cstddef>
#include <cstdint>

// Whether this processor has such products.
bool has_fast_checksum();

// Of some bytes behind others, whose checksum is `before`; 0 where there are none.
std::uint32_t checksum(const std::uint8_t* bytes, std::size_t count, std::uint32_t before);
