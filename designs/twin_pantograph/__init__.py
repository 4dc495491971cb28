"""Twin-Pantograph: two five-bars on waist hinges and a series roll actuator, 6 DOF (Stocco, Salcudean, Sassani)."""
