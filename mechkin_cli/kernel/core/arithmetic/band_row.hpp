// Where the entries of one unknown are in a matrix that is a band and a border (band.hpp).
#pragma once

struct BandRow {
  int begin, end;  // equations of its part of the band
  int at;          // its first entry: of the band, then of the border
  int reach;       // one more than the last unknown that the equation of the same number may hold
  int swaps;       // exchanges of rows up to the pivot of that equation
  int last;        // one more than the last equation of the band that holds the unknown; 0: none
};

// Where the entry of an equation and an unknown stands, `inner` equations being no border; -1 where it is zero.
inline int place_in_band(const BandRow& row, int equation, int inner) {
  if (equation >= inner) return row.at + row.end - row.begin + equation - inner;
  return equation >= row.begin && equation < row.end ? row.at + equation - row.begin : -1;
}
