"""Any Gymnasium environment as a habitat."""
