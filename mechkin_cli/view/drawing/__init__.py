"""Small line drawings of mechanisms: isometric, as SVG with fixed decimals."""
