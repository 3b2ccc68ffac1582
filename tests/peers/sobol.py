"""Sobol' indices by SALib of the results in a file, one a column, of so many inputs: for each result a line for each input."""

import sys

import numpy as np
from SALib.analyze import sobol

results, inputs = np.loadtxt(sys.argv[1], ndmin=2), int(sys.argv[2])
problem = {"num_vars": inputs, "names": [str(i) for i in range(inputs)], "bounds": [[0.0, 1.0]] * inputs}
for values in results.T:
    found = sobol.analyze(problem, values, calc_second_order=False, num_resamples=2)
    for first, total in zip(found["S1"], found["ST"]):
        print(f"{float(first)!r},{float(total)!r}")
