"""Pictures of runs: curves over a column, curves in a plane. Loaded only where one is asked for;
`figure` alone knows matplotlib."""
