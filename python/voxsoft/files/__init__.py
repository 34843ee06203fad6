"""What VoxSoft reads from and writes to the disk."""
