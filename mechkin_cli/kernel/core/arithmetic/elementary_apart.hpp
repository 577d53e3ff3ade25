// The elementary functions once per unit, for those who call them by number: a copy in every replay would cost room and
// gain nothing.
#pragma once

#include "arithmetic/elementary.hpp"

namespace {
namespace apart {

MECHKIN_APART Pack sin(Pack a) { return ::sin(a); }
MECHKIN_APART Pack cos(Pack a) { return ::cos(a); }
MECHKIN_APART Pack tan(Pack a) { return ::tan(a); }
MECHKIN_APART Pack asin(Pack a) { return ::asin(a); }
MECHKIN_APART Pack acos(Pack a) { return ::acos(a); }
MECHKIN_APART Pack atan2(Pack a, Pack b) { return ::atan2(a, b); }
MECHKIN_INLINE Pack atan(Pack a) { return apart::atan2(a, Pack(1.0)); }
MECHKIN_APART Pack exp(Pack a) { return ::exp(a); }
MECHKIN_APART Pack log(Pack a) { return ::log(a); }
MECHKIN_APART Pack pow(Pack a, Pack b) { return ::pow(a, b); }

}  // namespace apart
}  // namespace
