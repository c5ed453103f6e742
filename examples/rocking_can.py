"""A can that falls back on its bottom nearly flat leans farther round by an angle that hardly depends on how it turned."""

import numpy as np

import spincyl as sc

body = sc.Body.solid(1.0)
start = sc.State(0.3, 1e-3, 0.0, 0.0)
t = np.linspace(0.0, 5.0, 2001)

if __name__ == "__main__":
    limit = np.pi * np.sqrt((body.i1 + body.ell**2 + 1) / (body.i1 + body.ell**2))
    for w1 in (1e-2, start.w1, 1e-4):
        swing = sc.swing(body, sc.State(start.theta, w1, 0.0, 0.0))
        print(f"w1 = {w1:g}: within {np.degrees(swing.theta_min):.4f} degrees of flat it goes on", end=" ")
        print(f"by {np.degrees(swing.precession):.2f} degrees.")
    print(f"The limit of no turning is {np.degrees(limit):.2f} degrees.")
