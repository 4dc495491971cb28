"""SenSation: two planar arms, each driven at its tip link through a parallelogram."""
