"""PyBullet behind the protocol."""
